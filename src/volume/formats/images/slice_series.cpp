#include "volume/formats/images/slice_series.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
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

// A file and the place that its description says it has in the series.
struct PlacedFile {
  std::string name;
  std::optional<std::int64_t> place;
};

// Looks at every file, in the order of their names.
std::vector<PlacedFile> look_at(const SliceFiles& slices, const VolumeInfo& first, const OpenOptions& options) {
  std::vector<PlacedFile> files;
  for (const std::string& path : slices.files) {
    const OpenedVolume slice = open_slice(slices.kind, path, true, options);
    check_slice(slice.info, first);
    files.push_back({path, slice.place_in_series});
  }
  return files;
}

// Sorts files by their places. Throws BadInput unless every file has one of its own.
void sort_by_place(std::vector<PlacedFile>& files) {
  std::stable_sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.place < b.place; });
  // Files without a place come first.
  const std::string expected = "a plane of its own (FirstZ) in the description of each file";
  if (!files.front().place) bad_input(files.front().name, expected, "none, and some in others");
  for (std::size_t n = 1; n < files.size(); ++n) {
    if (files[n].place != files[n - 1].place) continue;
    bad_input(files[n].name, expected, "that of " + in_quotes(files[n - 1].name));
  }
}

// Puts files, which are in the order of their names, into that of the places that they say. Places that go with the
// names, or are all the same, say no other order.
void put_in_order(std::vector<PlacedFile>& files, std::vector<std::string>& notes) {
  bool same = true, ascend = true;
  std::optional<std::int64_t> last;
  for (const PlacedFile& file : files) {
    same = same && file.place == files.front().place;
    ascend = ascend && !(file.place && last && *file.place <= *last);
    if (file.place) last = file.place;
  }
  if (same || ascend) return;
  sort_by_place(files);
  notes.emplace_back(
      "slices are in the order of the planes in their descriptions (FirstZ), not in that of their names");
}

// Notes planes that no file has.
void note_missing(const std::vector<PlacedFile>& files, std::vector<std::string>& notes) {
  const std::optional<std::int64_t> first = files.front().place, last = files.back().place;
  if (!first || !last || !notes.empty()) return;
  const std::int64_t missing = *last - *first + 1 - static_cast<std::int64_t>(files.size());
  if (missing <= 0) return;
  notes.push_back(std::to_string(missing) + (missing == 1 ? " slice seems" : " slices seem") +
                  " to be missing by the planes in the descriptions (FirstZ)");
}

}  // namespace

OpenedVolume open_slice_series(const SliceFiles& slices, const OpenOptions& options) {
  const bool series = slices.files.size() > 1;
  OpenedVolume volume = open_slice(slices.kind, slices.files.front(), series, options);
  VolumeInfo& info = volume.info;
  std::vector<std::string> numbers = notes_on_numbers(slices.files);
  if (series) {
    check_slice(info, info);
    std::vector<PlacedFile> files = look_at(slices, info, options);
    put_in_order(files, info.notes);
    note_missing(files, numbers);
    const auto count = static_cast<std::int64_t>(files.size());
    const auto name = [files](std::int64_t n) { return files[static_cast<std::size_t>(n)].name; };
    const auto open = [kind = slices.kind, name](std::int64_t n) {
      return open_slice(kind, name(n), true, {}).samples;
    };
    volume.gaps = nullptr;  // those of the first slice alone
    volume.samples = std::make_unique<FileSequence>(count, info.slice_bytes(), open, name);
    info.dims[2] = count;
    checked_volume_bytes(info);
  }
  info.path = slices.path;
  info.data_files = slices.files;
  info.notes.insert(info.notes.begin(), slices.notes.begin(), slices.notes.end());
  info.remarks.insert(info.remarks.begin(), slices.remarks.begin(), slices.remarks.end());
  info.notes.insert(info.notes.end(), numbers.begin(), numbers.end());
  return volume;
}

}  // namespace isoweave
