#include "volume/formats/images/slice_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <set>
#include <system_error>
#include <utility>

#include "files/external_files.hpp"
#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "isoweave/printable.hpp"
#include "system/file_facts.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/unread_formats.hpp"

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

// The kind of a file. An empty file is a lost slice only if its name is that of a slice. Where only DICOM is looked
// for, pictures are other files.
SliceKind kind_of(const std::string& path, bool only_dicom) {
  const SliceKind named = kind_of_name(path);
  if (only_dicom && (named == SliceKind::kTiff || named == SliceKind::kPng)) return SliceKind::kOther;
  std::error_code error;
  if (named == SliceKind::kOther && fs::file_size(path, error) == 0) return SliceKind::kOther;
  const std::string head = open_file(path)->head(kDicomHeadBytes);
  SliceKind found = SliceKind::kOther;
  if (is_tiff(head)) found = SliceKind::kTiff;
  if (is_png(head)) found = SliceKind::kPng;
  if (is_dicom(head)) found = SliceKind::kDicom;
  if (only_dicom && found != SliceKind::kDicom) found = SliceKind::kOther;
  if (named != SliceKind::kOther && named != found) {
    bad_input(path, "content of " + std::string(name_of(named)), "other content");
  }
  return found;
}

void take_slice(SliceFiles& slices, const std::string& path, SliceKind kind) {
  if (slices.files.empty()) slices.kind = kind;
  if (kind != slices.kind) {
    bad_input(path, std::string(name_of(slices.kind)) + " as " + in_quotes(slices.files.front()),
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
  if (others.size() == 1) return "1 file of the folder is no slice and is left out: " + names;
  return std::to_string(others.size()) + " files of the folder are no slices and are left out: " + names;
}

// The index of an export, which a folder of DICOM files is known by.
bool is_dicomdir_name(const std::string& path) { return lower_case(fs::path(path).filename().string()) == "dicomdir"; }

// Whether a file lies beside slices as usual, by its name: papers, tables, archives and programs; in an export of DICOM
// pictures as well. Any other file might be a slice that is damaged or of a kind that is not read.
bool is_usual(const std::string& path, bool is_export) {
  static const std::set<std::string, std::less<>> kUsual{
      ".txt", ".md",  ".rst",  ".json", ".yaml", ".yml",  ".xml", ".csv",  ".tsv", ".log", ".ini", ".cfg",   ".inf",
      ".pdf", ".doc", ".docx", ".rtf",  ".xls",  ".xlsx", ".htm", ".html", ".css", ".js",  ".db",  ".lnk",   ".url",
      ".exe", ".dll", ".jar",  ".bat",  ".sh",   ".py",   ".m",   ".zip",  ".gz",  ".7z",  ".md5", ".sha256"};
  static const std::set<std::string, std::less<>> kPictures{".png",  ".tif", ".tiff", ".jpg",
                                                            ".jpeg", ".gif", ".bmp",  ".ico"};
  static const std::set<std::string, std::less<>> kNames{"dicomdir", "readme", "license", "lockfile", "version"};
  const fs::path name(lower_case(fs::path(path).filename().string()));
  const std::string ending = name.extension().string();
  if (ending.empty()) return kNames.contains(name.string());
  return kUsual.contains(ending) || (is_export && kPictures.contains(ending));
}

std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

struct Entries {
  std::vector<std::string> files, folders;
};

// The entries of a folder, without hidden files and folders. A link counts as the file that it leads to.
Entries entries_of(const std::string& folder) {
  Entries entries;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().filename().string().starts_with('.')) continue;
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) entries.files.push_back(entry->path().string());
    if (entry->is_directory(ignored)) entries.folders.push_back(entry->path().string());
  }
  if (error) bad_input(folder, "cannot be listed: " + error.message());
  std::sort(entries.files.begin(), entries.files.end(), natural_less);
  std::sort(entries.folders.begin(), entries.folders.end(), natural_less);
  return entries;
}

// Throws BadInput for a link out of the folder, where links may lead nowhere else. To be called before a file is opened
// and before a folder is listed.
void check_links(const std::vector<std::string>& names, const std::string& folder, const OpenOptions& options) {
  if (options.external) return;
  for (const std::string& name : names) check_within(name, folder);
}

// The files of all folders below one, each folder once, whatever links lead to it.
std::vector<std::string> files_below(const std::string& top, const OpenOptions& options) {
  constexpr std::size_t kDeepest = 16;
  constexpr std::size_t kMostFiles = 1 << 17;
  std::vector<std::string> files;
  std::error_code unknown;
  std::set<fs::path> seen{fs::canonical(top, unknown)};
  std::vector<std::string> level = entries_of(top).folders;
  for (std::size_t depth = 1; !level.empty(); ++depth) {
    if (depth > kDeepest) bad_input(top, "folders no deeper than " + std::to_string(kDeepest), in_quotes(level[0]));
    check_links(level, top, options);
    std::vector<std::string> next;
    for (const std::string& folder : level) {
      std::error_code error;
      if (!seen.insert(fs::canonical(folder, error)).second || error) continue;
      const Entries entries = entries_of(folder);
      files.insert(files.end(), entries.files.begin(), entries.files.end());
      next.insert(next.end(), entries.folders.begin(), entries.folders.end());
      if (files.size() + next.size() > kMostFiles) {
        bad_input(top, "no more than " + std::to_string(kMostFiles) + " files in folders below", "more");
      }
    }
    level = std::move(next);
  }
  check_links(files, top, options);
  return files;
}

std::vector<std::string> files_of_folder(const std::string& folder, const OpenOptions& options) {
  std::vector<std::string> files = entries_of(folder).files;
  check_links(files, folder, options);
  return files;
}

// The folder that all files of a pattern lie below.
std::string folder_of_pattern(const std::string& pattern) {
  return folder_of(pattern.substr(0, pattern.find_first_of("*?[\\")));
}

std::vector<std::string> files_of_pattern(const std::string& pattern, const OpenOptions& options) {
  std::optional<std::vector<std::string>> files = system::names_like(pattern);
  if (!files) bad_input(pattern, "cannot be expanded: a folder cannot be listed");
  if (files->empty()) bad_input(pattern, "files that match the pattern", "none");
  std::sort(files->begin(), files->end(), natural_less);
  // The folder of a file may be a link itself, where it matched the pattern.
  check_links(*files, folder_of_pattern(pattern), options);
  for (const std::string& file : *files) check_links({file}, folder_of(file), options);
  return std::move(*files);
}

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

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return a == b || fs::equivalent(a, b, error);
}

bool is_pattern(const std::string& path) {
  std::error_code error;
  return path.find_first_of("*?[") != std::string::npos && !fs::exists(path, error);
}

std::vector<std::string> files_of(const std::string& path, const OpenOptions& options) {
  return is_pattern(path) ? files_of_pattern(path, options) : files_of_folder(path, options);
}

namespace {

SliceFiles slices_of_pattern(const std::string& pattern, const OpenOptions& options) {
  SliceFiles slices;
  slices.path = pattern;
  for (const std::string& file : files_of_pattern(pattern, options)) {
    const SliceKind kind = kind_of(file, false);
    if (kind == SliceKind::kOther) {
      bad_input(file, "a slice in TIFF, PNG or DICOM", what_else(open_file(file)->head(kWhatElseBytes), file));
    }
    take_slice(slices, file, kind);
  }
  return slices;
}

void take_slices(SliceFiles& slices, std::vector<std::string>& others, const std::vector<std::string>& files,
                 bool only_dicom) {
  for (const std::string& file : files) {
    const SliceKind kind = kind_of(file, only_dicom);
    kind == SliceKind::kOther ? others.push_back(file) : take_slice(slices, file, kind);
  }
}

}  // namespace

SliceFiles find_slices(const std::string& path, const OpenOptions& options) {
  if (is_pattern(path)) return slices_of_pattern(path, options);
  SliceFiles slices;
  slices.path = path;
  std::vector<std::string> others;
  const std::vector<std::string> files = files_of_folder(path, options);
  const bool is_export = std::any_of(files.begin(), files.end(), is_dicomdir_name);
  take_slices(slices, others, files, is_export);
  const bool is_dicom = slices.files.empty() || slices.kind == SliceKind::kDicom;
  if (is_dicom) take_slices(slices, others, files_below(path, options), true);
  if (slices.files.empty()) bad_input(path, "slices in TIFF, PNG or DICOM", "a directory without any");
  const auto usual = std::stable_partition(others.begin(), others.end(),
                                           [&](const std::string& file) { return !is_usual(file, is_export); });
  if (usual != others.begin()) slices.notes.push_back(left_out({others.begin(), usual}));
  if (usual != others.end()) slices.remarks.push_back(left_out({usual, others.end()}));
  return slices;
}

SliceFiles slices_of_export(const std::string& dicomdir, const OpenOptions& options) {
  SliceFiles slices = find_slices(folder_of(dicomdir), options);
  slices.path = dicomdir;
  return slices;
}

std::vector<std::string> dicom_files_beside(const std::string& path, const OpenOptions& options) {
  std::vector<std::string> files;
  for (const std::string& name : files_of_folder(folder_of(path), options)) {
    std::error_code error;
    const bool empty = fs::file_size(name, error) == 0;
    if (!empty && is_dicom(open_file(name)->head(kDicomHeadBytes))) files.push_back(name);
  }
  // Whether the file is listed: hidden ones are not.
  const bool is_listed =
      std::any_of(files.begin(), files.end(), [&](const std::string& name) { return is_same_file(name, path); });
  if (!is_listed) files.push_back(path);
  return files;
}

}  // namespace isoweave
