// An array that is kept as a folder of objects, one per chunk or shard: the facts of its metadata, in any format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/object_store.hpp"
#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/chunked/chunk_codecs.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// The layout of an object that holds several chunks: a grid of `chunks` per axis behind an index of their places.
struct Shards {
  std::vector<std::int64_t> chunks;
  bool index_at_end = true;
  bool index_sum = false;  // the index ends in its CRC-32C
};

// The shards of a precomputed volume: the bits of a chunk's number, hashed or not, say where it lies.
struct PrecomputedShards {
  std::uint32_t preshift_bits = 0, minishard_bits = 0, shard_bits = 0;
  bool hashes = false;
  bool packed_index = false;  // by gzip
};

// The facts that neuroglancer's precomputed volumes have beside other arrays.
struct Precomputed {
  std::array<std::int64_t, 3> offset{};              // the first voxel along x, y, z
  std::array<std::int64_t, 3> segmentation_block{};  // of compressed_segmentation; 0: samples as they are
  std::optional<PrecomputedShards> shards;
};

struct ChunkedArray {
  StorePtr store;
  std::string folder;
  std::string header;           // the object of its metadata
  std::string format;           // "zarr", "n5" or "precomputed"
  std::vector<ArrayAxis> axes;  // from the slowest to the fastest
  std::vector<std::int64_t> chunk;
  std::vector<std::size_t> stored_order;  // axes as a chunk is stored, the slowest first
  SampleType type = SampleType::kUint8;
  bool is_half = false;  // the samples are the bits of 16-bit floats
  bool big_endian = false;
  std::array<std::byte, 8> fill{};  // one sample as it would be stored
  std::vector<Codec> codecs;        // in the order in which they are undone
  std::string key_prefix;           // "" or "c/"
  char separator = '.';
  bool reversed_keys = false;  // names of objects begin with the fastest axis (N5)
  bool block_headers = false;  // a chunk begins with its size, which is smaller at the end of an axis (N5)
  std::optional<Shards> shards;
  std::optional<Precomputed> precomputed;  // whose chunks are smaller at the end of an axis as well
  std::vector<std::string> notes;
};

// Throws BadInput unless the axes and chunks go together and are of sizes that can be worked with.
void check_array(const ChunkedArray& array);

// The samples of a volume in the array. A band as deep as a chunk is held. Throws BadInput when a band is out of all
// proportion to what the folder holds.
OpenedVolume open_chunks(const ChunkedArray& array, const AxisChoice& choice);

// The number of a chunk along every axis of its array.
using ChunkIndex = std::vector<std::int64_t>;

// One chunk as stored and decoded. `shape`: its samples along the axes, less than a whole chunk only with headers.
struct Chunk {
  std::vector<std::byte> samples;
  std::vector<std::int64_t> shape;
};

class ChunkPlaces;

// Reads chunks from the store of their array.
class ChunkReader {
 public:
  explicit ChunkReader(ChunkedArray array);
  ~ChunkReader();
  ChunkReader(const ChunkReader&) = delete;
  ChunkReader& operator=(const ChunkReader&) = delete;

  const ChunkedArray& array() const { return array_; }

  // Whether expect() makes reading faster.
  bool looks_ahead() const { return !array_.store->is_local(); }

  // Whether the store can be asked for a chunk without reading the index of a shard first.
  bool knows_places() const;

  // Names the chunks that will be read next, in that order, and those behind them.
  void expect(const std::vector<ChunkIndex>& next, const std::vector<ChunkIndex>& later);

  // False when the chunk is not stored, so that all of it is the fill value.
  bool read(const ChunkIndex& index, Chunk& chunk);

  // The most bytes that are held beside a chunk.
  std::uint64_t held_bytes() const;

 private:
  void decode(std::vector<std::byte> stored, const ChunkIndex& index, const std::string& path, Chunk& chunk) const;

  ChunkedArray array_;
  std::unique_ptr<ChunkPlaces> places_;
};

}  // namespace isoweave
