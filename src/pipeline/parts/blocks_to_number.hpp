// A surface in blocks, simplified to a number of triangles.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pipeline/parts/block_pass.hpp"
#include "pipeline/parts/kept_triangles.hpp"

namespace isoweave {

// The most triangles that one zone takes in the end where so many are wanted. A forecast aims at 1.4 times that.
inline std::uint64_t most_together(std::uint64_t triangles) { return triangles + triangles / 2 + 50'000; }

// The cost up to which a run to a number of triangles may decide everything at once, by RunControl::head_start or by a
// forecast. `open` opens the volume. A run to an error gets kUnknownCost.
CostBits head_start_of(const VolumeOpener& open, const MeshOptions& options, const RunControl& control);

// Passes over the surface with a limit on costs. A triangle is kept once all edges at its vertices are dearer. The kept
// ones are passed over with a higher limit, where one is known to leave enough, until they are so few that one zone
// takes all of them and ends at the number, as that of a sweep does.
class BlocksToNumber {
 public:
  // folder: where parts wait in a file; empty: they wait in memory. The other arguments are those of a pass.
  BlocksToNumber(const Task& task, const BlockStages& stages, const std::string& folder, const RunControl& control,
                 const Executor& executor, MeshReport& report);

  // The first pass over the surface of a volume, with a limit that may be too high.
  void extract(const VolumeOpener& open, CostBits limit, const BlockPass::Tell& tell);

  // In place of extract(), where that pass is made by others: takes what they have kept of a block, and their counts.
  void begin(CostBits limit) { limit_ = limit; }
  void keep(KeptTriangles kept);
  void count(const BlockTotals& totals) { totals_ += totals; }

  // Passes over what is kept, until that is little. Returns the limit with which to begin anew where one was too high.
  std::optional<CostBits> thin();

  // Decides what is kept, to the number, after thin(). All triangles of the simplifier are final then.
  std::unique_ptr<Simplifier> finish();

  std::uint64_t kept() const { return kept_->triangles(); }  // triangles
  std::uint64_t number() const { return number_; }  // to stop at, after thin(); a share is none before the first pass
  std::uint64_t kept_bytes() const { return kept_->bytes(); }
  const BlockTotals& totals() const { return totals_; }

 private:
  std::unique_ptr<PartStore> make_store() const;
  void pass(CostBits limit, const std::function<void(BlockPass& pass)>& run);
  bool has_overshot() const;
  CostBits safe_limit() const;

  const Task& task_;
  const BlockStages& stages_;
  const std::string folder_;
  const RunControl& control_;
  const Executor& executor_;
  MeshReport& report_;
  CostBits limit_ = kUnknownCost;  // of the last pass
  std::uint64_t number_ = 0;
  std::unique_ptr<PartStore> kept_;  // for the first stage of the next pass
  CostHistogram least_;              // costs of the triangles that are kept, each below those of its vertices
  BlockTotals totals_;
};

}  // namespace isoweave
