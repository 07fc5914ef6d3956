#include "volume/formats/chunked/compressed_segmentation.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "files/input_file.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kWord = 4;

// Words of 32 bits, least significant byte first.
class Words {
 public:
  Words(std::span<const std::byte> bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  std::uint32_t at(std::uint64_t n) const {
    if (n >= count()) bad_input(path_, "numbers within the " + std::to_string(count()) + " of the chunk", "one behind");
    std::uint32_t word = 0;
    for (std::size_t b = kWord; b-- > 0;) {
      word = word << 8U | std::to_integer<std::uint32_t>(bytes_[static_cast<std::size_t>(n) * kWord + b]);
    }
    return word;
  }

  // The bytes of `words` words, as they are.
  const std::byte* bytes_at(std::uint64_t n, std::size_t words) const {
    at(n + words - 1);
    return bytes_.data() + static_cast<std::size_t>(n) * kWord;
  }

 private:
  std::uint64_t count() const { return bytes_.size() / kWord; }

  std::span<const std::byte> bytes_;
  const std::string& path_;
};

// A block: where its table and its indices into the table begin, and the bits of an index.
struct Block {
  std::uint64_t table = 0, indices = 0;
  std::uint32_t bits = 0;
};

Block block_at(const Words& words, std::uint64_t channel, std::uint64_t number, const std::string& path) {
  constexpr std::uint32_t kTableBits = 24;
  const std::uint32_t head = words.at(channel + 2 * number);
  const Block block{channel + (head & ((1U << kTableBits) - 1)), channel + words.at(channel + 2 * number + 1),
                    head >> kTableBits};
  if (block.bits != 0 && (!std::has_single_bit(block.bits) || block.bits > 32)) {
    bad_input(path, "0, 1, 2, 4, 8, 16 or 32 bits for a sample", std::to_string(block.bits));
  }
  return block;
}

std::uint32_t index_in(const Words& words, const Block& block, std::uint64_t place) {
  constexpr std::uint64_t kBits = 32;
  if (block.bits == 0) return 0;
  const std::uint32_t word = words.at(block.indices + place * block.bits / kBits) >> (place * block.bits % kBits);
  return block.bits == kBits ? word : word & ((1U << block.bits) - 1);
}

// Writes the samples of the block that begins at `first`.
void put_block(const Words& words, const Block& block, const SegmentationShape& shape,
               const std::array<std::int64_t, 3>& first, std::byte* out) {
  std::array<std::int64_t, 3> end;
  for (std::size_t a = 0; a < 3; ++a) end.at(a) = std::min(first.at(a) + shape.block.at(a), shape.size.at(a));
  const std::size_t table_words = shape.sample_bytes / kWord;
  for (std::int64_t z = first[2]; z < end[2]; ++z) {
    for (std::int64_t y = first[1]; y < end[1]; ++y) {
      std::byte* to =
          out + static_cast<std::size_t>((z * shape.size[1] + y) * shape.size[0] + first[0]) * shape.sample_bytes;
      const std::int64_t row = ((z - first[2]) * shape.block[1] + y - first[1]) * shape.block[0];
      for (std::int64_t x = first[0]; x < end[0]; ++x, to += shape.sample_bytes) {
        const std::uint64_t index = index_in(words, block, static_cast<std::uint64_t>(row + x - first[0]));
        std::memcpy(to, words.bytes_at(block.table + index * table_words, table_words), shape.sample_bytes);
      }
    }
  }
}

void put_channel(const Words& words, std::uint64_t begin, const SegmentationShape& shape, const std::string& path,
                 std::byte* out) {
  std::uint64_t number = 0;
  for (std::int64_t z = 0; z < shape.size[2]; z += shape.block[2]) {
    for (std::int64_t y = 0; y < shape.size[1]; y += shape.block[1]) {
      for (std::int64_t x = 0; x < shape.size[0]; x += shape.block[0]) {
        put_block(words, block_at(words, begin, number++, path), shape, {x, y, z}, out);
      }
    }
  }
}

// Every block has a head of two words: a chunk that claims more samples than its heads can stand for takes no memory.
void check_heads(const Words& words, const SegmentationShape& shape) {
  std::uint64_t blocks = shape.channels;
  for (std::size_t a = 0; a < 3; ++a) {
    blocks *= static_cast<std::uint64_t>((shape.size.at(a) - 1) / shape.block.at(a) + 1);
  }
  words.at(2 * blocks + shape.channels - 1);
}

}  // namespace

std::vector<std::byte> decode_segmentation(std::span<const std::byte> stored, const SegmentationShape& shape,
                                           const std::string& path) {
  const Words words(stored, path);
  check_heads(words, shape);
  const std::size_t samples = to_size(shape.size[0] * shape.size[1] * shape.size[2], shape.sample_bytes);
  std::vector<std::byte> out(to_size(shape.channels, samples));
  for (std::size_t channel = 0; channel < shape.channels; ++channel) {
    put_channel(words, words.at(channel), shape, path, out.data() + channel * samples);
  }
  return out;
}

}  // namespace isoweave
