#include "volume/index_identity.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <system_error>
#include <vector>

#include "files/crc32.hpp"
#include "files/whole_input.hpp"
#include "isoweave/index.hpp"
#include "system/file_facts.hpp"

namespace isoweave {
namespace {

namespace fs = std::filesystem;

std::uint32_t add_text(std::uint32_t crc, const std::string& text) {
  return add_to_crc(crc, std::as_bytes(std::span(text.data(), text.size() + 1)));
}

std::string hexadecimal(std::uint32_t number) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(8, '0');
  for (std::size_t n = text.size(); n-- > 0; number >>= 4U) text[n] = kDigits[number & 15U];
  return text;
}

// The facts of files, whose order counts.
struct FileSum {
  std::uint64_t files = 0, bytes = 0;
  std::uint32_t crc = 0;

  // False where there is no such file. `name`: of a file in the volume's folder.
  bool add(const std::string& path, const std::string& name = {}) {
    const std::optional<system::FileFacts> facts = system::facts_of_file(path);
    if (!facts) return false;
    ++files;
    bytes += facts->bytes;
    const std::array<std::int64_t, 3> numbers{static_cast<std::int64_t>(facts->bytes), facts->seconds,
                                              facts->nanoseconds};
    crc = add_to_crc(add_text(crc, name), std::as_bytes(std::span(numbers)));
    return true;
  }
};

std::string name_of(const std::string& path) { return fs::path(path).filename().string(); }

// Adds the CRC of the first and the last bytes of a file: its header, and samples of the first and the last slice.
void add_content(const std::string& path, FileSum& sum) {
  constexpr std::streamoff kEnd = 4096;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  std::array<char, kEnd> bytes{};
  for (const std::streamoff begin : {std::streamoff{0}, std::max<std::streamoff>(size - kEnd, 0)}) {
    file.clear();
    file.seekg(begin);
    file.read(bytes.data(), kEnd);
    sum.crc = add_to_crc(sum.crc, std::as_bytes(std::span(bytes)).first(static_cast<std::size_t>(file.gcount())));
  }
}

// Adds all files below a folder, by their names from there. False where it cannot be listed.
bool add_folder(const std::string& folder, FileSum& sum) {
  std::vector<std::string> names;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) names.push_back(fs::path(entry->path()).lexically_relative(folder).string());
  }
  std::ranges::sort(names);
  for (const std::string& name : names) {
    if (!sum.add((fs::path(folder) / name).string(), name)) return false;
  }
  return !error;
}

// The facts of all files that hold the volume; nothing where one is missing, or where there is none.
std::optional<FileSum> sum_of_files(const VolumeInfo& volume) {
  FileSum sum;
  if (volume.format == "zarr" || volume.format == "n5" || volume.format == "precomputed") {
    if (!add_folder(fs::path(volume.header).parent_path().string(), sum)) return std::nullopt;
    add_content(volume.header, sum);
    return sum;
  }
  std::vector<std::string> files = volume.data_files;
  std::error_code ignored;
  if (fs::is_regular_file(volume.path, ignored)) files.insert(files.begin(), volume.path);
  for (const std::string& file : files) {
    if (!sum.add(file)) return std::nullopt;
  }
  if (files.empty()) return std::nullopt;
  for (const std::string& file : {files.front(), files.back()}) add_content(file, sum);
  return sum;
}

// The beginning that the names of all indices of a volume's file share: the part that was chosen is in the name.
std::string index_name(const VolumeInfo& volume) {
  std::string name = name_of(fs::path(volume.path + "/").parent_path().string());
  if (!volume.part.empty()) name += "." + hexadecimal(add_text(0, volume.part));
  return name;
}

std::optional<fs::path> cache_folder() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache != '\0') return fs::path(cache) / "isoweave";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return fs::path(home) / ".cache" / "isoweave";
  return std::nullopt;
}

constexpr const char* kEnding = ".minmax";

}  // namespace

std::string volume_identity(const VolumeInfo& volume) {
  const std::optional<FileSum> sum = sum_of_files(volume);
  if (!sum) return {};
  const auto& [nx, ny, nz] = volume.dims;
  std::uint32_t reading = add_text(add_text(0, volume.part), volume.layout);
  for (const std::string& note : volume.notes) reading = add_text(reading, note);
  return volume.format + " " + std::to_string(nx) + " x " + std::to_string(ny) + " x " + std::to_string(nz) + " " +
         std::string(sample_type_name(volume.type)) + ", read as " + hexadecimal(reading) + ", " +
         std::to_string(sum->bytes) + " bytes in " + std::to_string(sum->files) + " files, " + hexadecimal(sum->crc);
}

std::vector<std::string> index_places(const VolumeInfo& volume) {
  std::error_code error;
  const fs::path path = fs::path(volume.path + "/").parent_path();
  // The name of standard input stands for another volume in the next run.
  const bool is_there = path != kStandardInput && fs::exists(path, error);
  if (!is_there && volume.data_files.empty()) return {};
  std::vector<std::string> places;
  if (is_there) places.push_back((path.parent_path() / (index_name(volume) + kEnding)).string());
  if (const std::optional<fs::path> cache = cache_folder()) {
    const std::string whole = fs::absolute(path, error).lexically_normal().string();
    places.push_back((*cache / (index_name(volume) + "-" + hexadecimal(add_text(0, whole)) + kEnding)).string());
  }
  return places;
}

std::string find_index(const VolumeInfo& volume) {
  for (const std::string& place : index_places(volume)) {
    if (system::facts_of_file(place)) return place;
  }
  return {};
}

}  // namespace isoweave
