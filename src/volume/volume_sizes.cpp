#include "volume/volume_sizes.hpp"

#include <stdexcept>
#include <string>

#include "files/input_file.hpp"

namespace isoweave {
namespace {

std::string dims_text(const VolumeInfo& info) {
  return std::to_string(info.dims[0]) + " x " + std::to_string(info.dims[1]) + " x " + std::to_string(info.dims[2]);
}

}  // namespace

void check_slice_range(const VolumeInfo& info, std::int64_t next, std::int64_t first, std::int64_t count,
                       std::size_t out_bytes) {
  if (first < next) {
    throw std::invalid_argument("slice " + std::to_string(first) + " lies behind slice " + std::to_string(next) +
                                ", the next to be read");
  }
  if (count < 0 || first > info.dims[2] || count > info.dims[2] - first) {
    throw std::invalid_argument(std::to_string(count) + " slices from " + std::to_string(first) +
                                " are not all in a volume of " + std::to_string(info.dims[2]));
  }
  if (count > 0 && out_bytes / info.slice_bytes() < static_cast<std::uint64_t>(count)) {
    throw std::invalid_argument("the memory given holds fewer than " + std::to_string(count) + " slices");
  }
}

std::uint64_t checked_volume_bytes(const VolumeInfo& info) {
  auto bytes = static_cast<std::int64_t>(sample_bytes(info.type));
  bool overflow = false;
  for (const std::int64_t side : info.dims) {
    if (side < 1) bad_input(info.path, "dimensions of at least 1", dims_text(info));
    overflow = overflow || __builtin_mul_overflow(bytes, side, &bytes);
  }
  if (overflow) bad_input(info.path, "a volume of fewer than 2^63 bytes", dims_text(info) + " samples");
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace isoweave
