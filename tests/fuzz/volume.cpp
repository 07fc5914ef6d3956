// Opens the input as a volume, looks at its header, and reads all of it twice: slice by slice, and the last slice
// alone, and in the same way a second channel and time.
#include "isoweave/volume.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "input_files.hpp"
#include "isoweave/histogram.hpp"

namespace {

using namespace isoweave;

// Larger volumes are not read: an input of some kilobytes may stand for gigabytes of zeros.
constexpr std::size_t kReadable = std::size_t{1} << 22;
// Where each sample may be a file that has to be looked for.
constexpr std::size_t kReadableFromChunks = std::size_t{1} << 16;

void expect_sane(const VolumeInfo& info) {
  const Geometry& geometry = info.geometry;
  std::int64_t bytes = static_cast<std::int64_t>(sample_bytes(info.type));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (info.dims[axis] < 1) fuzz::broken_promise("dimensions of at least 1");
    if (__builtin_mul_overflow(bytes, info.dims[axis], &bytes)) fuzz::broken_promise("a size that fits in 63 bits");
    if (!(geometry.spacing[axis] > 0) || !std::isfinite(geometry.spacing[axis])) fuzz::broken_promise("spacing");
    if (!std::isfinite(geometry.origin[axis])) fuzz::broken_promise("a finite origin");
    double length = 0;
    for (std::size_t row = 0; row < 3; ++row) length += std::pow(geometry.direction[3 * row + axis], 2);
    if (!(std::abs(length - 1) < 1e-6)) fuzz::broken_promise("directions of unit length");
  }
  if (!std::isfinite(info.slope) || !std::isfinite(info.intercept) || info.slope == 0) fuzz::broken_promise("scaling");
  for (const std::string& note : info.notes) {
    if (note.find('\n') != std::string::npos) fuzz::broken_promise("notes of one line");
  }
}

void read_volume(const std::string& path) {
  const auto volume = open_volume(path);
  const VolumeInfo& info = volume->info();
  expect_sane(info);
  const std::int64_t slices = info.dims[2];
  const std::size_t most =
      info.format == "zarr" || info.format == "n5" || info.format == "precomputed" ? kReadableFromChunks : kReadable;
  if (info.slice_bytes() > most / static_cast<std::size_t>(slices)) return;
  otsu_threshold(read_histogram(*volume));
  std::vector<std::byte> last(info.slice_bytes());
  open_volume(path)->read(slices - 1, 1, last);
}

// The second channel and the second time, where there are such axes.
void read_further(const std::string& path) {
  for (const bool channel : {true, false}) {
    OpenOptions options;
    (channel ? options.channel : options.time) = 1;
    options.slices_from = channel ? SliceAxis::kTimes : SliceAxis::kSlices;
    const auto volume = open_volume(path, options);
    expect_sane(volume->info());
    const std::int64_t slices = volume->info().dims[2];
    if (volume->info().slice_bytes() > kReadableFromChunks) return;
    std::vector<std::byte> last(volume->info().slice_bytes());
    volume->read(slices - 1, 1, last);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFiles files(fuzz::kInputNames);
  files.put({data, size});
  fuzz::expect_bad_input_at_worst(read_volume, files.path());
  fuzz::expect_bad_input_at_worst(read_further, files.path());
  return 0;
}
