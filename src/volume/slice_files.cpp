#include "volume/slice_files.hpp"

#include <glob.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "volume/formats.hpp"
#include "volume/header_text.hpp"
#include "volume/input_file.hpp"
#include "volume/printable.hpp"

namespace isoweave {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Cuts the leading run of digits off a text, without its zeros in front.
std::string_view take_number(std::string_view& text) {
  const auto* const end = std::find_if_not(text.begin(), text.end(), is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

std::string_view name_of(SliceKind kind) {
  static constexpr std::array<std::string_view, 4> kNames{"no slice", "TIFF", "PNG", "DICOM"};
  return kNames.at(static_cast<std::size_t>(kind));
}

SliceKind kind_of_name(const std::string& path) {
  const std::string name = lower_case(path);
  if (name.ends_with(".tif") || name.ends_with(".tiff")) return SliceKind::kTiff;
  if (name.ends_with(".png")) return SliceKind::kPng;
  if (name.ends_with(".dcm")) return SliceKind::kDicom;
  return SliceKind::kOther;
}

// What a file holds; an empty file is a slice that was lost only if its name is that of a slice.
SliceKind kind_of(const std::string& path) {
  const SliceKind named = kind_of_name(path);
  std::error_code error;
  if (named == SliceKind::kOther && fs::file_size(path, error) == 0) return SliceKind::kOther;
  const std::string head = open_file(path)->head(kDicomHeadBytes);
  SliceKind found = SliceKind::kOther;
  if (is_tiff(head)) found = SliceKind::kTiff;
  if (is_png(head)) found = SliceKind::kPng;
  if (is_dicom(head)) found = SliceKind::kDicom;
  if (named != SliceKind::kOther && named != found) {
    bad_input(path, "content of " + std::string(name_of(named)), "other content");
  }
  return found;
}

void take_slice(SliceFiles& slices, const std::string& path, SliceKind kind) {
  if (slices.files.empty()) slices.kind = kind;
  if (kind != slices.kind) {
    bad_input(path, std::string(name_of(slices.kind)) + " as " + isoweave::quoted(slices.files.front()),
              std::string(name_of(kind)));
  }
  slices.files.push_back(path);
}

std::string left_out(const std::vector<std::string>& others) {
  constexpr std::size_t kNamed = 3;
  std::string names;
  for (std::size_t n = 0; n < std::min(others.size(), kNamed); ++n) {
    names += (n == 0 ? "" : ", ") + printable(fs::path(others[n]).filename().string());
  }
  if (others.size() > kNamed) names += ", ...";
  return std::to_string(others.size()) + " files of the folder are no slices and are left out: " + names;
}

// A folder that is not there holds no match; one that may not be listed might.
int gives_up(const char*, int error) { return error == ENOENT || error == ENOTDIR ? 0 : 1; }

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::pair<std::string_view, std::string_view> whole(a, b);
  while (!a.empty() && !b.empty()) {
    if (is_digit(a[0]) && is_digit(b[0])) {
      const std::string_view x = take_number(a);
      const std::string_view y = take_number(b);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      continue;
    }
    if (a[0] != b[0]) return static_cast<unsigned char>(a[0]) < static_cast<unsigned char>(b[0]);
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  // "z1" and "z01" are the same by number.
  return whole.first < whole.second;
}

bool is_folder(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_pattern(const std::string& path) {
  std::error_code error;
  return path.find_first_of("*?[") != std::string::npos && !fs::exists(path, error);
}

std::vector<std::string> files_of_folder(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const bool hidden = entry->path().filename().string().starts_with('.');
    std::error_code ignored;
    if (!hidden && entry->is_regular_file(ignored)) files.push_back(entry->path().string());
  }
  if (error) bad_input(folder, "cannot be listed: " + error.message());
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

std::vector<std::string> files_of_pattern(const std::string& pattern) {
  glob_t found{};
  const int result = ::glob(pattern.c_str(), GLOB_NOSORT, gives_up, &found);
  std::vector<std::string> files;
  for (std::size_t n = 0; result == 0 && n < found.gl_pathc; ++n) files.emplace_back(found.gl_pathv[n]);
  ::globfree(&found);
  if (result != 0 && result != GLOB_NOMATCH) bad_input(pattern, "cannot be expanded: a folder cannot be listed");
  if (files.empty()) bad_input(pattern, "files that match the pattern", "none");
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

SliceFiles find_slices(const std::string& path) {
  const bool folder = !is_pattern(path);
  SliceFiles slices;
  slices.path = path;
  std::vector<std::string> others;
  for (const std::string& file : folder ? files_of_folder(path) : files_of_pattern(path)) {
    const SliceKind kind = kind_of(file);
    if (kind != SliceKind::kOther) {
      take_slice(slices, file, kind);
    } else if (folder) {
      others.push_back(file);
    } else {
      bad_input(file, "a slice in TIFF, PNG or DICOM", "other content");
    }
  }
  if (slices.files.empty()) bad_input(path, "slices in TIFF, PNG or DICOM", "a directory without any");
  if (!others.empty()) slices.notes.push_back(left_out(others));
  return slices;
}

std::vector<std::string> dicom_files_beside(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::vector<std::string> files;
  for (const std::string& name : files_of_folder(folder.empty() ? "." : folder.string())) {
    std::error_code error;
    const bool empty = fs::file_size(name, error) == 0;
    if (!empty && is_dicom(open_file(name)->head(kDicomHeadBytes))) files.push_back(name);
  }
  return files;
}

}  // namespace isoweave
