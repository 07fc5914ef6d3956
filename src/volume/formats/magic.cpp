// Tells files by their first bytes, and folders by their files, for the readers that a build may lack.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "files/header_text.hpp"
#include "volume/formats/dicom/dicom_bare.hpp"
#include "volume/formats/formats.hpp"

namespace isoweave {

bool is_tiff(std::string_view head) {
  for (const std::string_view magic : {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                       std::string_view("II+\0", 4), std::string_view("MM\0+", 4)}) {
    if (head.starts_with(magic)) return true;
  }
  return false;
}

bool is_png(std::string_view head) { return head.starts_with("\x89PNG\r\n\x1a\n"); }

bool is_dicom(std::string_view head) { return has_dicom_magic(head) || is_bare_dicom(head); }

// Whether the magic of DICOM stands behind a preamble of 128 bytes of anything.
bool has_dicom_magic(std::string_view head) {
  constexpr std::string_view kMagic = "DICM";
  return head.size() >= kDicomMagicEnd && head.substr(kDicomMagicEnd - kMagic.size(), kMagic.size()) == kMagic;
}

bool is_hdf5(const InputFile& file) {
  constexpr std::string_view kMagic = "\x89HDF\r\n\x1a\n";
  constexpr std::uint64_t kFirstBlock = 512;
  // In a file that is inflated while it is read, looks only at the bytes at hand.
  const std::uint64_t end = file.jumps() ? file.size() : std::min<std::uint64_t>(file.size(), kLargestHeader);
  for (std::uint64_t at = 0; at < end; at = at == 0 ? kFirstBlock : 2 * at) {
    std::array<char, kMagic.size()> head{};
    file.read_at(at, std::as_writable_bytes(std::span(head)));
    if (std::equal(head.begin(), head.end(), kMagic.begin())) return true;
  }
  return false;
}

namespace {

// Whether a folder is that of a precomputed volume. Those of meshes and skeletons have an `info` as well.
bool is_precomputed(const std::string& folder) {
  std::ifstream file(std::filesystem::path(folder) / "info", std::ios::binary);
  std::string head(std::size_t{1} << 16, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head.starts_with('{') && head.find("\"scales\"") != std::string::npos;
}

}  // namespace

bool is_array_folder(const std::string& folder) {
  static constexpr std::array<const char*, 5> kNames{"zarr.json", ".zarray", ".zgroup", ".zattrs", "attributes.json"};
  return is_precomputed(folder) || std::any_of(kNames.begin(), kNames.end(), [&folder](const char* name) {
           std::error_code error;
           return std::filesystem::is_regular_file(std::filesystem::path(folder) / name, error);
         });
}

}  // namespace isoweave
