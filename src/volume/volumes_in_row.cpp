#include "volume/volumes_in_row.hpp"

#include <string>
#include <vector>

#include "files/input_file.hpp"
#include "volume/formats/chunked/array_axes.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {

std::uint64_t choose_in_row(VolumeInfo& info, std::int64_t count, const OpenOptions& options) {
  const std::vector<ArrayAxis> axes{{count, "time"}, {info.dims[2], "z"}, {info.dims[1], "y"}, {info.dims[0], "x"}};
  std::uint64_t before = 0;
  const std::uint64_t each = checked_volume_bytes(info);
  const AxisChoice choice = choose_axes(axes, options, info.path);
  if (__builtin_mul_overflow(static_cast<std::uint64_t>(choice.at[0]), each, &before) || before >> 63 != 0) {
    bad_input(info.path, "volumes of fewer than 2^63 bytes in all", std::to_string(count));
  }
  info.dims = choice.dims(axes);
  checked_volume_bytes(info);
  info.part = choice.part;
  info.notes.insert(info.notes.end(), choice.notes.begin(), choice.notes.end());
  return before;
}

}  // namespace isoweave
