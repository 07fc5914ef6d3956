#include "volume/formats/dicom/dicom_series.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "files/quoted.hpp"
#include "volume/formats/dicom/dicom_file.hpp"
#include "volume/formats/dicom/dicom_volume.hpp"
#include "volume/formats/formats.hpp"

namespace isoweave {
namespace {

using Series = std::vector<DicomSlice>;

using SeriesByUid = std::map<std::string, Series>;

// Stands for the UID of a series that has none.
constexpr std::string_view kWithoutUid = "none";

std::string name_of(const std::string& uid) { return uid.empty() ? std::string(kWithoutUid) : uid; }

std::string listing(const SeriesByUid& all) {
  constexpr std::size_t kListed = 20;
  std::string text = std::to_string(all.size()) + " series: ";
  std::size_t n = 0;
  for (const auto& [uid, series] : all) {
    if (n++ == kListed) return text + "; ...";
    text += (n == 1 ? "" : "; ") + name_of(uid) + " (" + in_quotes(series.front().description) + ", " +
            std::to_string(series.size()) + (series.size() == 1 ? " slice)" : " slices)");
  }
  return text;
}

const Series& chosen_series(const SeriesByUid& all, const std::string& chosen, const std::string& path) {
  if (chosen.empty() && all.size() == 1) return all.begin()->second;
  if (chosen.empty()) bad_input(path, "one series, or --series UID for one of them", listing(all));
  const auto found = all.find(chosen == kWithoutUid ? std::string() : chosen);
  if (found == all.end()) bad_input(path, "the series " + in_quotes(chosen), listing(all));
  return found->second;
}

}  // namespace

OpenedVolume open_dicom_series(const SliceFiles& slices, const OpenOptions& options) {
  SeriesByUid all;
  std::int64_t without_image = 0;
  for (const std::string& path : slices.files) {
    const std::vector<DicomSlice> slices_of_file = read_dicom_header(path);
    for (const DicomSlice& slice : slices_of_file) all[slice.series].push_back(slice);
    if (slices_of_file.empty()) ++without_image;
  }
  if (all.empty())
    bad_input(slices.path, "DICOM images",
              std::to_string(without_image) + (without_image == 1 ? " file without one" : " files without one"));
  OpenedVolume volume = open_dicom_slices(chosen_series(all, options.series, slices.path), slices.path, options);
  std::vector<std::string>& notes = volume.info.notes;
  notes.insert(notes.begin(), slices.notes.begin(), slices.notes.end());
  volume.info.remarks = slices.remarks;
  if (without_image > 0) {
    volume.info.remarks.push_back(without_image == 1
                                      ? "1 DICOM file holds no image and is left out"
                                      : std::to_string(without_image) + " DICOM files hold no image and are left out");
  }
  return volume;
}

namespace {

using Places = std::set<std::pair<std::string, double>>;

Places places_of(const Series& slices) {
  Places places;
  for (const DicomSlice& slice : slices) places.emplace(slice.position, slice.offset);
  return places;
}

// Whether two files are stacks in one place: several volumes, of which a file that is named is one.
bool is_other_volume(const Series& slices, const Places& of_named_file) {
  return std::any_of(slices.begin(), slices.end(), [&](const DicomSlice& slice) {
    return of_named_file.contains({slice.position, slice.offset});
  });
}

}  // namespace

OpenedVolume open_dicom_file(const std::string& path, const OpenOptions& options) {
  const std::vector<DicomSlice> self = read_dicom_header(path);
  if (self.empty()) bad_input(path, "a DICOM image", "a DICOM file without one");
  const std::string& uid = self.front().series;
  const std::string& chosen = options.series;
  if (!chosen.empty() && chosen != name_of(uid))
    bad_input(path, "the series " + in_quotes(chosen), in_quotes(name_of(uid)));
  if (self.front().segmentation) return open_dicom_slices(self, path, options);  // a volume by itself
  Series series;
  const Places places = places_of(self);
  std::size_t files = 0;
  std::size_t others = 0;
  for (const std::string& name : dicom_files_beside(path, options)) {
    const std::vector<DicomSlice> slices = read_dicom_header(name);
    if (slices.empty() || slices.front().series != uid) continue;
    if (self.size() > 1 && !is_same_file(name, path) && is_other_volume(slices, places)) {
      ++others;
      continue;
    }
    ++files;
    series.insert(series.end(), slices.begin(), slices.end());
  }
  OpenedVolume volume = open_dicom_slices(series, path, options);
  if (files > 1) {
    volume.info.remarks.push_back("the series of this file: " + std::to_string(files) + " files of its folder");
  }
  if (others > 0) {
    volume.info.notes.push_back(std::to_string(others) + (others == 1 ? " file" : " files") +
                                " of the same series in the same place " + (others == 1 ? "is" : "are") +
                                " left out: another volume");
  }
  return volume;
}

}  // namespace isoweave
