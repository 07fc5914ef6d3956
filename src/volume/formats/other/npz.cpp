// NPZ, NumPy's archive of arrays: a zip file with an NPY file for each, by its name.
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "isoweave/error.hpp"
#include "isoweave/printable.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/npy_array.hpp"
#include "volume/packed_file.hpp"
#include "volume/zip_file.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kEnding = ".npy";

struct NpzArray {
  std::string name;  // without the ending
  ZipRecord record;
};

std::vector<NpzArray> arrays_of(const FilePtr& file) {
  std::vector<NpzArray> arrays;
  for (ZipRecord& record : read_zip_directory(file)) {
    if (!record.name.ends_with(kEnding)) continue;
    const std::string name = record.name.substr(0, record.name.size() - kEnding.size());
    arrays.push_back({name, std::move(record)});
  }
  if (arrays.empty()) bad_input(file->path(), "arrays of NumPy in the archive", "none");
  return arrays;
}

FilePtr open_array(const FilePtr& file, const NpzArray& array) {
  const ZipRecord& record = array.record;
  return std::make_shared<PackedFile>(file->path(), record.bytes,
                                      [file, record] { return open_zip_entry(file, record); });
}

// An array of the archive, as far as it is known before it is chosen.
struct NpzLook {
  bool is_volume = false;
  std::string text;  // "'ct' (5 x 4 x 3 int16)"
};

NpzLook look_at(const FilePtr& file, const NpzArray& array) {
  constexpr std::size_t kVolumeAxes = 3;
  try {
    const NpyHeader header = read_npy_header(open_array(file, array));
    const std::optional<StoredType> type = npy_type(header);
    std::string text = in_quotes(array.name) + " (";
    for (const ArrayAxis& axis : header.axes) text += std::to_string(axis.size) + " x ";
    text.resize(header.axes.empty() ? text.size() : text.size() - 2);
    text += type ? std::string(stored_type_name(*type)) : printable(header.type);
    return {type && header.axes.size() >= kVolumeAxes, text + ")"};
  } catch (const BadInput&) {
    return {false, in_quotes(array.name) + " (not read)"};
  }
}

const NpzArray& named_array(const FilePtr& file, const std::vector<NpzArray>& arrays, const std::string& name) {
  constexpr std::size_t kMostNamed = 12;
  std::string listed;
  for (std::size_t n = 0; n < arrays.size(); ++n) {
    if (arrays[n].name == name || arrays[n].record.name == name) return arrays[n];
    if (n < kMostNamed) listed += (n == 0 ? "" : ", ") + in_quotes(arrays[n].name);
  }
  if (arrays.size() > kMostNamed) listed += " and " + std::to_string(arrays.size() - kMostNamed) + " more";
  bad_input(file->path(), "an array " + in_quotes(name), listed);
}

// The one that is taken when none is named: the only array, or the only one of three axes or more.
const NpzArray& only_array(const FilePtr& file, const std::vector<NpzArray>& arrays, VolumeInfo& info) {
  constexpr std::size_t kMostLooks = 256, kMostListed = 12;
  if (arrays.size() == 1) return arrays.front();
  if (arrays.size() > kMostLooks) {
    bad_input(file->path(), "--dataset with the name of one of its arrays", std::to_string(arrays.size()) + " of them");
  }
  const NpzArray* chosen = nullptr;
  std::size_t volumes = 0;
  std::string listed;
  for (std::size_t n = 0; n < arrays.size(); ++n) {
    const NpzLook look = look_at(file, arrays[n]);
    if (look.is_volume && volumes++ == 0) chosen = &arrays[n];
    if (n < kMostListed) listed += (n == 0 ? "" : ", ") + look.text;
  }
  if (arrays.size() > kMostListed) listed += " and " + std::to_string(arrays.size() - kMostListed) + " more";
  if (volumes != 1) bad_input(file->path(), "--dataset with one of " + listed, "no choice");
  info.notes.push_back(in_quotes(chosen->name) + " is the only array of 3 axes or more, and is read");
  return *chosen;
}

}  // namespace

bool is_npz(std::string_view head, std::string_view path) {
  return is_zip(head) && (first_zip_name(head).ends_with(kEnding) || lower_case(path).ends_with(".npz"));
}

OpenedVolume open_npz(const FilePtr& file, const OpenOptions& options) {
  const std::vector<NpzArray> arrays = arrays_of(file);
  VolumeInfo found;
  const NpzArray& array =
      options.dataset.empty() ? only_array(file, arrays, found) : named_array(file, arrays, options.dataset);
  const FilePtr content = open_array(file, array);
  if (!is_npy(content->head(kLargestHeader)))
    bad_input(file->path(), "NPY in " + in_quotes(array.name), "other content");
  OpenedVolume volume = open_npy_array(content, read_npy_header(content), options);
  VolumeInfo& info = volume.info;
  info.format = "npz";
  info.part = "array " + printable(array.name) + (info.part.empty() ? "" : ", " + info.part);
  info.notes.insert(info.notes.begin(), found.notes.begin(), found.notes.end());
  return volume;
}

}  // namespace isoweave
