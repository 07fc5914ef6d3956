#include "volume/formats/images/slice_series.hpp"

#include <string>
#include <utility>
#include <vector>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/images/slice_numbers.hpp"

namespace isoweave {
namespace {

OpenedVolume open_slice(SliceKind kind, const std::string& path, bool one_of_series, const OpenOptions& options) {
  const FilePtr file = open_file(path);
  return kind == SliceKind::kTiff ? open_tiff(file, one_of_series, options) : open_png(file);
}

std::string text_of(const VolumeInfo& info) {
  std::string text = std::to_string(info.dims[0]) + " x " + std::to_string(info.dims[1]) + " " +
                     std::string(sample_type_name(info.type));
  if (info.slope != 1 || info.intercept != 0) {
    text += " scaled by " + number_text(info.slope) + " and " + number_text(info.intercept);
  }
  return text;
}

void check_slice(const VolumeInfo& slice, const VolumeInfo& first) {
  if (slice.dims[2] != 1) {
    bad_input(slice.path, "one page in each file of a series", std::to_string(slice.dims[2]));
  }
  const bool same = slice.dims == first.dims && slice.type == first.type && slice.slope == first.slope &&
                    slice.intercept == first.intercept;
  if (!same) bad_input(slice.path, text_of(first) + " as in " + in_quotes(first.path), text_of(slice));
}

}  // namespace

OpenedVolume open_slice_series(const SliceFiles& slices, const OpenOptions& options) {
  const bool series = slices.files.size() > 1;
  OpenedVolume volume = open_slice(slices.kind, slices.files.front(), series, options);
  VolumeInfo& info = volume.info;
  if (series) {
    check_slice(info, info);
    for (const std::string& path : slices.files) check_slice(open_slice(slices.kind, path, series, options).info, info);
    const auto count = static_cast<std::int64_t>(slices.files.size());
    const auto name = [slices](std::int64_t n) { return slices.files[static_cast<std::size_t>(n)]; };
    const auto open = [slices, name](std::int64_t n) { return open_slice(slices.kind, name(n), true, {}).samples; };
    volume.gaps = nullptr;  // those of the first slice alone
    volume.samples = std::make_unique<FileSequence>(count, info.slice_bytes(), open, name);
    info.dims[2] = count;
    checked_volume_bytes(info);
  }
  info.path = slices.path;
  info.data_files = slices.files;
  info.notes.insert(info.notes.begin(), slices.notes.begin(), slices.notes.end());
  info.remarks.insert(info.remarks.begin(), slices.remarks.begin(), slices.remarks.end());
  const std::vector<std::string> numbers = notes_on_numbers(slices.files);
  info.notes.insert(info.notes.end(), numbers.begin(), numbers.end());
  return volume;
}

}  // namespace isoweave
