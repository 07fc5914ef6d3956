#include "volume/formats/images/tiff_directory.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace isoweave {
namespace {

// Numbers of either byte order at places that may lie behind the end.
class TiffBytes {
 public:
  explicit TiffBytes(const InputFile& file) : file_(file) {
    const std::string head = file.head(4);
    big_endian_ = head.starts_with('M');
    constexpr std::uint64_t kBigTiff = 43;
    big_tiff_ = head.size() == 4 && number(2, 2) == kBigTiff;
  }

  bool big_tiff() const { return big_tiff_; }

  std::uint64_t number(std::uint64_t at, std::size_t bytes) const {
    std::array<std::byte, 8> raw{};
    const std::span<std::byte> wanted = std::span(raw).first(bytes);
    if (file_.read_at(at, wanted) < bytes) {
      bad_input(file_.path(), "a TIFF directory at byte " + std::to_string(at),
                "a file of " + std::to_string(file_.size()));
    }
    if (!big_endian_) std::reverse(wanted.begin(), wanted.end());
    std::uint64_t value = 0;
    for (const std::byte byte : wanted) value = value << 8 | std::to_integer<std::uint64_t>(byte);
    return value;
  }

 private:
  const InputFile& file_;
  bool big_endian_ = false;
  bool big_tiff_ = false;
};

// Bytes of one value of a type; 0 for types that nobody reads.
std::uint64_t value_bytes(std::uint64_t type) {
  static constexpr std::array<std::uint8_t, 19> kBytes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
  return type < kBytes.size() ? kBytes[static_cast<std::size_t>(type)] : 0;
}

}  // namespace

void check_tiff_directory(const InputFile& file, std::uint64_t offset) {
  const TiffBytes bytes(file);
  const std::size_t word = bytes.big_tiff() ? 8 : 4;
  const std::size_t count_bytes = bytes.big_tiff() ? 8 : 2;
  const std::uint64_t entry_bytes = 4 + 2 * word;
  const std::uint64_t entries = bytes.number(offset, count_bytes);
  if (entries > (file.size() - offset) / entry_bytes) {
    bad_input(file.path(), "a TIFF directory of " + std::to_string(entries) + " tags at byte " + std::to_string(offset),
              "a file of " + std::to_string(file.size()));
  }
  for (std::uint64_t n = 0; n < entries; ++n) {
    const std::uint64_t at = offset + count_bytes + n * entry_bytes;
    const std::uint64_t each = value_bytes(bytes.number(at + 2, 2));
    const std::uint64_t count = bytes.number(at + 4, word);
    if (each == 0 || count <= word / each) continue;
    const std::uint64_t begin = bytes.number(at + 4 + word, word);
    if (begin > file.size() || count > (file.size() - begin) / each) {
      bad_input(file.path(),
                std::to_string(count) + " values of tag " + std::to_string(bytes.number(at, 2)) + " at byte " +
                    std::to_string(begin),
                "a file of " + std::to_string(file.size()));
    }
  }
  // The link to the next directory.
  bytes.number(offset + count_bytes + entries * entry_bytes, word);
}

}  // namespace isoweave
