// The objects behind the opaque handles of the C interface.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <variant>

#include "isoweave/isoweave.h"
#include "isoweave/mesh.hpp"
#include "isoweave/volume.hpp"

namespace isoweave::capi {

// A volume that can be read any number of times: each run gets a source of its own.
class VolumeOpener {
 public:
  using Open = std::function<std::unique_ptr<SliceSource>()>;

  // Opens the volume once, for its header.
  explicit VolumeOpener(Open open) : open_(std::move(open)), first_(open_()), info_(first_->info()) {}

  const VolumeInfo& info() const { return info_; }

  // A source at its beginning. The first one is the source that the header came from, as a pipe has only one.
  std::unique_ptr<SliceSource> open() const {
    {
      const std::scoped_lock lock(mutex_);
      if (first_ != nullptr) return std::move(first_);
    }
    return open_();
  }

 private:
  const Open open_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<SliceSource> first_;
  const VolumeInfo info_;
};

}  // namespace isoweave::capi

// NOLINTBEGIN(readability-identifier-naming): names of the C interface
struct iw_stop {
  std::shared_ptr<std::atomic<bool>> wish = std::make_shared<std::atomic<bool>>(false);
};

// Parts of a volume share its opener, so they outlive the handle.
struct iw_volume {
  std::shared_ptr<const isoweave::capi::VolumeOpener> opener;
};

// A mesh that a run has made, where it has made it, or one from elsewhere.
struct iw_mesh {
  std::variant<isoweave::TriangleMesh, isoweave::MeshInMemory> content;
  std::string unit, space;
};
// NOLINTEND(readability-identifier-naming)

namespace isoweave::capi {

// The mesh as calls want it. `copy` holds it where the handle has it in another form.
const TriangleMesh& triangle_mesh(const iw_mesh& mesh, TriangleMesh& copy);

}  // namespace isoweave::capi
