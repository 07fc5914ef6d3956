// Files of chunks: their names, headers and shards.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/external_files.hpp"
#include "files/input_file.hpp"
#include "parallel/size.hpp"
#include "volume/formats/chunked/chunked_array.hpp"

namespace isoweave {
namespace {

namespace fs = std::filesystem;

// The file, or nothing when there is none of this name. `root`: as in ChunkedArray.
FilePtr open_if_there(const std::string& path, const std::string& root) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return nullptr;
  if (!root.empty()) check_within(path, root);
  return open_file(path);
}

std::vector<std::byte> bytes_of(const InputFile& file, std::uint64_t begin, std::size_t count) {
  std::vector<std::byte> bytes(count);
  if (file.read_at(begin, bytes) < count) {
    bad_input(file.path(), std::to_string(count) + " bytes from byte " + std::to_string(begin) + " on", "fewer");
  }
  return bytes;
}

template <class Word>
Word big_endian(std::span<const std::byte> bytes) {
  Word word = 0;
  for (std::size_t n = 0; n < sizeof(Word); ++n)
    word = static_cast<Word>((word << 8) | std::to_integer<Word>(bytes[n]));
  return word;
}

// Cuts the header off an N5 block: a mode, the number of axes, the samples along each, the fastest first.
std::vector<std::int64_t> take_block_shape(std::vector<std::byte>& stored, const ChunkedArray& array,
                                           const std::string& path) {
  constexpr std::size_t kFixed = 4;
  constexpr std::size_t kWord = 4;
  const std::size_t axes = array.axes.size();
  const std::size_t bytes = kFixed + kWord * axes;
  const std::span<const std::byte> head(stored);
  if (head.size() < bytes) bad_input(path, "the header of a block", std::to_string(head.size()) + " bytes");
  const auto mode = big_endian<std::uint16_t>(head);
  if (mode != 0) bad_input(path, "a block of the default mode", "mode " + std::to_string(mode));
  if (big_endian<std::uint16_t>(head.subspan(2)) != axes) bad_input(path, "a block of the array's axes", "another");
  std::vector<std::int64_t> shape(axes);
  for (std::size_t n = 0; n < axes; ++n) {
    const auto size = static_cast<std::int64_t>(big_endian<std::uint32_t>(head.subspan(kFixed + kWord * n)));
    const std::size_t axis = axes - 1 - n;
    if (size < 1 || size > array.chunk[axis]) {
      bad_input(path, "a block of at most " + std::to_string(array.chunk[axis]) + " samples along an axis",
                std::to_string(size));
    }
    shape[axis] = size;
  }
  stored.erase(stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(bytes));
  return shape;
}

std::size_t count_of(const std::vector<std::int64_t>& shape) {
  std::size_t count = 1;
  for (const std::int64_t size : shape) count = to_size(size, count);
  return count;
}

}  // namespace

// One file of several chunks.
struct ChunkReader::Shard {
  struct Place {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
  };
  std::string path;
  FilePtr file;  // none: the shard is not stored
  std::vector<Place> index;
};

ChunkReader::ChunkReader(ChunkedArray array) : array_(std::move(array)) {
  chunk_bytes_ = to_size(count_of(array_.chunk), sample_bytes(array_.type));
}

ChunkReader::~ChunkReader() = default;

std::string ChunkReader::path_of(const std::vector<std::int64_t>& file_index) const {
  std::string key;
  for (std::size_t n = 0; n < file_index.size(); ++n) {
    if (n > 0) key += array_.separator;
    key += std::to_string(file_index[array_.reversed_keys ? file_index.size() - 1 - n : n]);
  }
  return array_.folder + "/" + array_.key_prefix + key;
}

void ChunkReader::decode(std::vector<std::byte> stored, const std::string& path, Chunk& chunk) const {
  chunk.shape = array_.block_headers ? take_block_shape(stored, array_, path) : array_.chunk;
  chunk.samples =
      decode_chunk(std::move(stored), array_.codecs, count_of(chunk.shape) * sample_bytes(array_.type), path);
}

std::optional<std::vector<std::byte>> ChunkReader::from_shard(const std::vector<std::int64_t>& index,
                                                              const std::string& path) {
  const Shards& shards = *array_.shards;
  if (!shard_ || shard_->path != path) {
    auto shard = std::make_unique<Shard>();
    shard->path = path;
    shard->file = open_if_there(path, array_.root);
    if (shard->file) {
      const std::size_t count = count_of(shards.chunks);
      const std::size_t bytes = to_size(count, sizeof(Shard::Place)) + (shards.index_sum ? sizeof(std::uint32_t) : 0);
      const std::uint64_t size = shard->file->size();
      if (size < bytes) bad_input(path, "an index of " + std::to_string(bytes) + " bytes", std::to_string(size));
      std::vector<std::byte> stored = bytes_of(*shard->file, shards.index_at_end ? size - bytes : 0, bytes);
      constexpr std::array kSum{Codec::kCrc32c};
      if (shards.index_sum) stored = decode_chunk(std::move(stored), kSum, count * sizeof(Shard::Place), path);
      shard->index.resize(count);
      std::memcpy(shard->index.data(), stored.data(), stored.size());
    }
    shard_ = std::move(shard);
  }
  if (!shard_->file) return std::nullopt;
  std::size_t slot = 0;
  for (std::size_t n = 0; n < index.size(); ++n) {
    slot = slot * static_cast<std::size_t>(shards.chunks[n]) + static_cast<std::size_t>(index[n] % shards.chunks[n]);
  }
  const auto [offset, bytes] = shard_->index.at(slot);
  if (offset == ~std::uint64_t{0} && bytes == ~std::uint64_t{0}) return std::nullopt;
  const std::uint64_t size = shard_->file->size();
  if (offset > size || bytes > size - offset || bytes > most_stored(chunk_bytes_)) {
    bad_input(path, "a chunk of at most " + std::to_string(most_stored(chunk_bytes_)) + " bytes inside the file",
              std::to_string(bytes) + " bytes from byte " + std::to_string(offset) + " on");
  }
  return bytes_of(*shard_->file, offset, static_cast<std::size_t>(bytes));
}

bool ChunkReader::read(const std::vector<std::int64_t>& index, Chunk& chunk) {
  std::vector<std::int64_t> file_index = index;
  if (array_.shards) {
    for (std::size_t n = 0; n < index.size(); ++n) file_index[n] /= array_.shards->chunks[n];
  }
  const std::string path = path_of(file_index);
  if (array_.shards) {
    std::optional<std::vector<std::byte>> stored = from_shard(index, path);
    if (stored) decode(std::move(*stored), path, chunk);
    return stored.has_value();
  }
  const FilePtr file = open_if_there(path, array_.root);
  if (!file) return false;
  if (file->size() > most_stored(chunk_bytes_)) {
    bad_input(path,
              "at most " + std::to_string(most_stored(chunk_bytes_)) + " bytes for a chunk of " +
                  std::to_string(chunk_bytes_),
              std::to_string(file->size()));
  }
  decode(bytes_of(*file, 0, static_cast<std::size_t>(file->size())), path, chunk);
  return true;
}

}  // namespace isoweave
