// The places of the stored bytes of chunks: in objects of their own, or in shards.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/object_store.hpp"
#include "volume/formats/chunked/chunked_array.hpp"

namespace isoweave {

class ChunkPlaces {
 public:
  ChunkPlaces() = default;
  virtual ~ChunkPlaces() = default;
  ChunkPlaces(const ChunkPlaces&) = delete;
  ChunkPlaces& operator=(const ChunkPlaces&) = delete;

  // The place of a chunk, whether there is an object or not; nothing where an index says that no such chunk is stored.
  virtual std::optional<ObjectPart> find(const ChunkIndex& index) = 0;

  // Whether places are found without reading an index first.
  virtual bool are_known() const = 0;

  // The most bytes of indices that are held.
  virtual std::uint64_t held_bytes() const { return 0; }
};

// array: must outlive the places.
std::unique_ptr<ChunkPlaces> chunk_places(const ChunkedArray& array);

// The most bytes that a stored chunk may have.
std::uint64_t most_chunk_bytes(const ChunkedArray& array);

// The samples of a box of this shape.
std::size_t sample_count(const std::vector<std::int64_t>& shape);

// The last indices of shards that were read, by the paths of their objects.
template <class Index>
class ShardIndices {
 public:
  // The most bytes that are held, unless one index alone has more.
  static constexpr std::uint64_t kMostBytes = 8 << 20;

  // The index; null where it is not held.
  const Index* find(const std::string& path) const {
    for (const Entry& entry : entries_) {
      if (entry.path == path) return &entry.index;
    }
    return nullptr;
  }

  const Index& add(const std::string& path, Index index, std::uint64_t bytes) {
    while (!entries_.empty() && bytes_ + bytes > kMostBytes) {
      bytes_ -= entries_.front().bytes;
      entries_.pop_front();
    }
    bytes_ += bytes;
    return entries_.push_back({path, std::move(index), bytes}), entries_.back().index;
  }

 private:
  struct Entry {
    std::string path;
    Index index;
    std::uint64_t bytes = 0;
  };
  std::deque<Entry> entries_;
  std::uint64_t bytes_ = 0;
};

}  // namespace isoweave
