// The places of chunks of precomputed volumes: objects named by boxes of voxels, or shards.
#include "volume/formats/chunked/precomputed_places.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

#include "files/input_file.hpp"
#include "files/murmur_hash.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kWordBytes = 8;

std::uint64_t word_at(const std::vector<std::byte>& bytes, std::size_t n) {
  std::uint64_t word = 0;
  for (std::size_t b = kWordBytes; b-- > 0;) {
    word = word << 8U | std::to_integer<std::uint64_t>(bytes[n * kWordBytes + b]);
  }
  return word;
}

// The number of a chunk along x, y, z.
std::array<std::int64_t, 3> along_axes(const ChunkIndex& index) { return {index[3], index[2], index[1]}; }

class BoxObjects final : public ChunkPlaces {
 public:
  explicit BoxObjects(const ChunkedArray& array) : array_(array), most_bytes_(most_chunk_bytes(array)) {}

  std::optional<ObjectPart> find(const ChunkIndex& index) override {
    std::string name;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t axis = 3 - a;
      const std::int64_t first = along_axes(index).at(a) * array_.chunk[axis];
      const std::int64_t end = std::min(first + array_.chunk[axis], array_.axes[axis].size);
      const std::int64_t offset = array_.precomputed->offset.at(a);
      name += (a == 0 ? "/" : "_") + std::to_string(offset + first) + "-" + std::to_string(offset + end);
    }
    return ObjectPart{array_.folder + name, 0, most_bytes_, true};
  }
  bool are_known() const override { return true; }

 private:
  const ChunkedArray& array_;
  std::uint64_t most_bytes_;
};

class PrecomputedShardPlaces final : public ChunkPlaces {
 public:
  explicit PrecomputedShardPlaces(const ChunkedArray& array)
      : array_(array), shards_(*array.precomputed->shards), most_bytes_(most_chunk_bytes(array)) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t axis = 3 - a;
      grid_.at(a) = static_cast<std::uint64_t>((array.axes[axis].size - 1) / array.chunk[axis] + 1);
    }
  }

  std::optional<ObjectPart> find(const ChunkIndex& index) override {
    std::array<std::uint64_t, 3> chunk;
    std::ranges::transform(along_axes(index), chunk.begin(),
                           [](std::int64_t n) { return static_cast<std::uint64_t>(n); });
    const std::uint64_t number = compressed_morton(chunk, grid_);
    const std::uint64_t shifted = shards_.preshift_bits < 64 ? number >> shards_.preshift_bits : 0;
    const std::uint64_t hash = shards_.hashes ? murmur_hash(shifted) : shifted;
    const std::uint64_t minishard = hash & low_bits(shards_.minishard_bits);
    const std::uint64_t shard = (hash >> shards_.minishard_bits) & low_bits(shards_.shard_bits);
    const std::string path = shard_path(shard);
    const Minishard& places = minishard_of(path, minishard);
    const auto found = std::ranges::lower_bound(places, number, {}, &Place::number);
    if (found == places.end() || found->number != number || found->bytes == 0) return std::nullopt;
    if (found->bytes > most_bytes_) {
      bad_input(path, "a chunk of at most " + std::to_string(most_bytes_) + " bytes", std::to_string(found->bytes));
    }
    return ObjectPart{path, found->offset, found->bytes, false};
  }
  bool are_known() const override { return false; }
  std::uint64_t held_bytes() const override { return ShardIndices<Minishard>::kMostBytes; }

 private:
  struct Place {
    std::uint64_t number = 0, offset = 0, bytes = 0;
  };
  using Minishard = std::vector<Place>;  // by number
  static constexpr std::uint64_t kMostIndexBytes = 64 << 20;

  static std::uint64_t low_bits(std::uint32_t bits) {
    return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  }

  std::string shard_path(std::uint64_t shard) const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string name((shards_.shard_bits + 3) / 4, '0');
    for (std::size_t n = name.size(); n-- > 0; shard >>= 4U) name[n] = kDigits[shard & 15U];
    return array_.folder + "/" + name + ".shard";
  }

  const Minishard& minishard_of(const std::string& path, std::uint64_t minishard) {
    const std::string name = path + "#" + std::to_string(minishard);
    if (const Minishard* const held = indices_.find(name)) return *held;
    Minishard places = read_minishard(path, minishard);
    const std::uint64_t bytes = name.size() + sizeof(Minishard) + places.size() * sizeof(Place);
    return indices_.add(name, std::move(places), bytes);
  }

  // Offsets count from the end of the index of the shard, whose entries lie one after another.
  Minishard read_minishard(const std::string& path, std::uint64_t minishard) const {
    constexpr std::uint64_t kEntryBytes = 2 * kWordBytes;
    const std::uint64_t base = kEntryBytes << shards_.minishard_bits;
    const auto entry = array_.store->read({path, minishard * kEntryBytes, kEntryBytes, false});
    if (!entry) return {};
    const std::uint64_t begin = word_at(*entry, 0), end = word_at(*entry, 1);
    if (begin >= end) return {};
    if (end - begin > kMostIndexBytes || begin > ~base) {
      bad_input(path, "the index of a minishard of at most " + std::to_string(kMostIndexBytes) + " bytes",
                "bytes " + std::to_string(begin) + " to " + std::to_string(end));
    }
    auto stored = array_.store->read({path, base + begin, end - begin, false});
    if (!stored) bad_input(path, "an object that stays as it is while it is read", "none");
    constexpr std::array kGzip{Codec::kDeflate};
    if (shards_.packed_index) stored = undo_codecs(std::move(*stored), kGzip, kMostIndexBytes, path);
    return places_in(*stored, base, path);
  }

  // Three lists: the differences of numbers, the gaps between chunks, and their bytes.
  static Minishard places_in(const std::vector<std::byte>& stored, std::uint64_t base, const std::string& path) {
    const std::size_t count = stored.size() / (3 * kWordBytes);
    if (count * 3 * kWordBytes != stored.size()) {
      bad_input(path, "three numbers for each chunk of a minishard", std::to_string(stored.size()) + " bytes");
    }
    Minishard places(count);
    Place last{0, base, 0};
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint64_t gap = word_at(stored, count + n), bytes = word_at(stored, 2 * count + n);
      places[n] = {last.number + word_at(stored, n), last.offset + last.bytes + gap, bytes};
      const bool sorted = n == 0 || places[n].number > last.number;
      if (!sorted || places[n].offset < last.offset || places[n].offset + bytes < places[n].offset) {
        bad_input(path, "the chunks of a minishard one after another", "another order");
      }
      last = places[n];
    }
    return places;
  }

  const ChunkedArray& array_;
  PrecomputedShards shards_;
  std::uint64_t most_bytes_;
  std::array<std::uint64_t, 3> grid_{};
  ShardIndices<Minishard> indices_;
};

}  // namespace

std::uint64_t compressed_morton(const std::array<std::uint64_t, 3>& chunk, const std::array<std::uint64_t, 3>& grid) {
  std::uint64_t code = 0;
  unsigned place = 0;
  for (unsigned bit = 0; bit < 64 && place < 64; ++bit) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (bit >= std::bit_width(grid.at(a) - 1)) continue;
      code |= (chunk.at(a) >> bit & 1U) << place;
      ++place;
    }
  }
  return code;
}

std::unique_ptr<ChunkPlaces> precomputed_places(const ChunkedArray& array) {
  if (array.precomputed->shards) return std::make_unique<PrecomputedShardPlaces>(array);
  return std::make_unique<BoxObjects>(array);
}

}  // namespace isoweave
