#include <lz4.h>

#include <cstring>
#include <limits>

#include "files/input_file.hpp"
#include "volume/formats/chunked/chunk_codecs.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t n = 0; n < sizeof word; ++n) word |= std::to_integer<std::uint32_t>(bytes[at + n]) << (8 * n);
  return word;
}

// Appends one block that must decode to `bytes` bytes.
void append_block(std::vector<std::byte>& decoded, std::span<const std::byte> block, std::size_t bytes,
                  const std::string& path) {
  constexpr std::uint64_t kRatio = 256;  // a byte of length stands for 255
  check_plausible(path, bytes, block.size(), kRatio);
  const std::size_t before = decoded.size();
  decoded.resize(before + bytes);
  const bool small = block.size() <= std::numeric_limits<int>::max() && bytes <= std::numeric_limits<int>::max();
  const int got = small ? LZ4_decompress_safe(reinterpret_cast<const char*>(block.data()),
                                              reinterpret_cast<char*>(decoded.data() + before),
                                              static_cast<int>(block.size()), static_cast<int>(bytes))
                        : -1;
  if (got < 0 || static_cast<std::size_t>(got) != bytes) {
    bad_input(path, "a block of LZ4 of " + std::to_string(bytes) + " bytes", "damaged data");
  }
}

}  // namespace

std::vector<std::byte> decode_lz4(std::span<const std::byte> stored, std::size_t most, const std::string& path) {
  constexpr std::size_t kHead = 4;
  if (stored.size() < kHead)
    bad_input(path, "a block of LZ4 behind its size", std::to_string(stored.size()) + " bytes");
  const std::size_t bytes = word_at(stored, 0);
  if (bytes > most) bad_input(path, "at most " + std::to_string(most) + " bytes in LZ4", std::to_string(bytes));
  std::vector<std::byte> decoded;
  append_block(decoded, stored.subspan(kHead), bytes, path);
  return decoded;
}

// Blocks: "LZ4Block", a byte whose high half is the method, sizes stored and decoded, a checksum. An empty one ends.
std::vector<std::byte> decode_lz4_frames(std::span<const std::byte> stored, std::size_t most, const std::string& path) {
  constexpr std::size_t kHead = 21;
  constexpr std::string_view kMagic = "LZ4Block";
  constexpr std::byte kPlain{0x10};
  std::vector<std::byte> decoded;
  while (!stored.empty()) {
    if (stored.size() < kHead || std::memcmp(stored.data(), kMagic.data(), kMagic.size()) != 0) {
      bad_input(path, "the magic LZ4Block", "other data");
    }
    const std::byte method = stored[kMagic.size()] & std::byte{0xf0};
    const std::size_t packed = word_at(stored, kMagic.size() + 1);
    const std::size_t bytes = word_at(stored, kMagic.size() + 5);
    stored = stored.subspan(kHead);
    if (bytes == 0) break;
    if (packed > stored.size() || bytes > most - decoded.size()) {
      bad_input(path, "at most " + std::to_string(most) + " bytes in LZ4", "larger blocks");
    }
    if (method == kPlain) {
      if (packed != bytes) bad_input(path, "a plain block of one size", "two sizes");
      decoded.insert(decoded.end(), stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(bytes));
    } else {
      append_block(decoded, stored.first(packed), bytes, path);
    }
    stored = stored.subspan(packed);
  }
  return decoded;
}

}  // namespace isoweave
