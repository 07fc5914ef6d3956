#include "volume/formats/chunked/chunk_places.hpp"

#include <array>
#include <cstring>
#include <vector>

#include "files/input_file.hpp"
#include "parallel/size.hpp"
#include "volume/formats/chunked/precomputed_places.hpp"

namespace isoweave {
namespace {

std::string path_of(const ChunkedArray& array, const ChunkIndex& index) {
  std::string key;
  for (std::size_t n = 0; n < index.size(); ++n) {
    if (n > 0) key += array.separator;
    key += std::to_string(index[array.reversed_keys ? index.size() - 1 - n : n]);
  }
  return array.folder + "/" + array.key_prefix + key;
}

// An object for each chunk.
class ChunkObjects final : public ChunkPlaces {
 public:
  explicit ChunkObjects(const ChunkedArray& array) : array_(array), most_bytes_(most_chunk_bytes(array)) {}

  std::optional<ObjectPart> find(const ChunkIndex& index) override {
    return ObjectPart{path_of(array_, index), 0, most_bytes_, true};
  }
  bool are_known() const override { return true; }

 private:
  const ChunkedArray& array_;
  std::uint64_t most_bytes_;
};

// Objects of Zarr 3 that hold several chunks and an index of their places.
class ZarrShards final : public ChunkPlaces {
 public:
  explicit ZarrShards(const ChunkedArray& array)
      : array_(array), shards_(*array.shards), most_bytes_(most_chunk_bytes(array)) {}

  std::optional<ObjectPart> find(const ChunkIndex& index) override {
    ChunkIndex shard = index;
    std::size_t slot = 0;
    for (std::size_t n = 0; n < index.size(); ++n) {
      shard[n] /= shards_.chunks[n];
      slot =
          slot * static_cast<std::size_t>(shards_.chunks[n]) + static_cast<std::size_t>(index[n] % shards_.chunks[n]);
    }
    const std::string path = path_of(array_, shard);
    const Index& places = index_of(path);
    if (!places.is_stored) return std::nullopt;
    const auto [offset, bytes] = places.places.at(slot);
    if (offset == ~std::uint64_t{0} && bytes == ~std::uint64_t{0}) return std::nullopt;
    if (offset > places.size || bytes > places.size - offset || bytes > most_bytes_) {
      bad_input(path, "a chunk of at most " + std::to_string(most_bytes_) + " bytes inside the file",
                std::to_string(bytes) + " bytes from byte " + std::to_string(offset) + " on");
    }
    return ObjectPart{path, offset, bytes, false};
  }
  bool are_known() const override { return false; }
  std::uint64_t held_bytes() const override { return ShardIndices<Index>::kMostBytes; }

 private:
  struct Place {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
  };
  struct Index {
    bool is_stored = false;
    std::uint64_t size = 0;  // of the shard
    std::vector<Place> places;
  };

  const Index& index_of(const std::string& path) {
    if (const Index* const held = indices_.find(path)) return *held;
    Index index = read_index(path);
    const std::uint64_t bytes = path.size() + sizeof index + index.places.size() * sizeof(Place);
    return indices_.add(path, std::move(index), bytes);
  }

  Index read_index(const std::string& path) const {
    const std::optional<std::uint64_t> size = array_.store->size(path);
    if (!size) return {};
    const std::size_t count = sample_count(shards_.chunks);
    const std::size_t bytes = to_size(count, sizeof(Place)) + (shards_.index_sum ? sizeof(std::uint32_t) : 0);
    if (*size < bytes) bad_input(path, "an index of " + std::to_string(bytes) + " bytes", std::to_string(*size));
    std::optional<std::vector<std::byte>> stored =
        array_.store->read({path, shards_.index_at_end ? *size - bytes : 0, bytes, false});
    if (!stored) bad_input(path, "an object that stays as it is while it is read", "none");
    constexpr std::array kSum{Codec::kCrc32c};
    if (shards_.index_sum) stored = decode_chunk(std::move(*stored), kSum, count * sizeof(Place), path);
    Index index{true, *size, std::vector<Place>(count)};
    std::memcpy(index.places.data(), stored->data(), stored->size());
    return index;
  }

  const ChunkedArray& array_;
  Shards shards_;
  std::uint64_t most_bytes_;
  ShardIndices<Index> indices_;
};

}  // namespace

std::size_t sample_count(const std::vector<std::int64_t>& shape) {
  std::size_t count = 1;
  for (const std::int64_t size : shape) count = to_size(size, count);
  return count;
}

// Each block of a compressed segmentation may have a table of all its samples.
std::uint64_t most_chunk_bytes(const ChunkedArray& array) {
  const std::size_t bytes = to_size(sample_count(array.chunk), sample_bytes(array.type));
  const bool tables = array.precomputed && array.precomputed->segmentation_block[0] > 0;
  return most_stored(tables ? 3 * bytes : bytes);
}

std::unique_ptr<ChunkPlaces> chunk_places(const ChunkedArray& array) {
  if (array.precomputed) return precomputed_places(array);
  if (array.shards) return std::make_unique<ZarrShards>(array);
  return std::make_unique<ChunkObjects>(array);
}

}  // namespace isoweave
