// The index of a volume, as mesh finds it.
#pragma once

#include <memory>
#include <string>

#include "isoweave/index.hpp"
#include "options/cli_app.hpp"
#include "options/input_volume.hpp"

namespace isoweave::cli {

inline constexpr const char* kIndexAuto = "auto";
inline constexpr const char* kIndexOff = "off";

struct IndexOptions {
  std::string path = kIndexAuto;  // or of a file, or kIndexOff

  bool named() const { return path != kIndexAuto && path != kIndexOff; }
};

void add_index_option(CLI::App& verb, IndexOptions& index);

// An index and the file that it came from.
struct FoundIndex {
  std::string path;
  std::shared_ptr<const VolumeIndex> index;  // null: there is none to use
};

// Reads the index that is named, or the one that lies in its place, unless the volume comes from a stranger: so may the
// index. One that lies there and is of another volume, or damaged, is not used, with a warning unless `quiet`. Throws
// BadInput where a named one cannot be used, and std::invalid_argument where it is named for a part of a volume.
FoundIndex open_index(const IndexOptions& index, const InputOptions& input, const VolumeInfo& volume, bool quiet);

}  // namespace isoweave::cli
