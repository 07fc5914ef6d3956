// An array that is kept as a folder of files, one per chunk or shard: the facts of its metadata, in any format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/chunked/chunk_codecs.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// The layout of a file that holds several chunks: a grid of `chunks` per axis behind an index of their places.
struct Shards {
  std::vector<std::int64_t> chunks;
  bool index_at_end = true;
  bool index_sum = false;  // the index ends in its CRC-32C
};

struct ChunkedArray {
  std::string folder;
  std::string header;           // the file of its metadata
  std::string format;           // "zarr" or "n5"
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
  bool reversed_keys = false;  // names of files begin with the fastest axis (N5)
  bool block_headers = false;  // a chunk begins with its size, which is smaller at the end of an axis (N5)
  std::optional<Shards> shards;
  std::string root;  // no file is read that lies outside this folder; empty: wherever links lead
  std::vector<std::string> notes;
};

// Throws BadInput unless the axes and chunks go together and are of sizes that can be worked with.
void check_array(const ChunkedArray& array);

// The samples of a volume in the array. A band as deep as a chunk is held. Throws BadInput when a band is out of all
// proportion to what the folder holds.
OpenedVolume open_chunks(const ChunkedArray& array, const AxisChoice& choice);

// One chunk as stored and decoded. `shape`: its samples along the axes, less than a whole chunk only with headers.
struct Chunk {
  std::vector<std::byte> samples;
  std::vector<std::int64_t> shape;
};

// Reads chunks from their files.
class ChunkReader {
 public:
  explicit ChunkReader(ChunkedArray array);
  ~ChunkReader();
  ChunkReader(const ChunkReader&) = delete;
  ChunkReader& operator=(const ChunkReader&) = delete;

  const ChunkedArray& array() const { return array_; }

  // False when the chunk is not stored, so that all of it is the fill value.
  bool read(const std::vector<std::int64_t>& index, Chunk& chunk);

 private:
  struct Shard;
  std::string path_of(const std::vector<std::int64_t>& file_index) const;
  void decode(std::vector<std::byte> stored, const std::string& path, Chunk& chunk) const;
  std::optional<std::vector<std::byte>> from_shard(const std::vector<std::int64_t>& index, const std::string& path);

  ChunkedArray array_;
  std::size_t chunk_bytes_ = 0;
  std::unique_ptr<Shard> shard_;  // the last one that was read from
};

}  // namespace isoweave
