// Chunks, from the bytes that a store has of them to samples.
#include <algorithm>
#include <utility>

#include "files/input_file.hpp"
#include "parallel/size.hpp"
#include "volume/formats/chunked/chunk_places.hpp"
#include "volume/formats/chunked/chunked_array.hpp"
#include "volume/formats/chunked/compressed_segmentation.hpp"

namespace isoweave {
namespace {

// The end of the name of a precomputed chunk in gzip, where files are written without headers of HTTP (cloud-volume).
constexpr std::string_view kPackedEnding = ".gz";

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

// The part of a chunk that lies in the array.
std::vector<std::int64_t> shape_inside(const ChunkIndex& index, const ChunkedArray& array) {
  std::vector<std::int64_t> shape = array.chunk;
  for (std::size_t n = 0; n < shape.size(); ++n) {
    shape[n] = std::min(shape[n], array.axes[n].size - index[n] * array.chunk[n]);
  }
  return shape;
}

SegmentationShape segmentation_shape(const std::vector<std::int64_t>& shape, const ChunkedArray& array) {
  return {{shape[3], shape[2], shape[1]},
          array.precomputed->segmentation_block,
          static_cast<std::size_t>(shape[0]),
          sample_bytes(array.type)};
}

}  // namespace

ChunkReader::ChunkReader(ChunkedArray array) : array_(std::move(array)), places_(chunk_places(array_)) {}

ChunkReader::~ChunkReader() = default;

bool ChunkReader::knows_places() const { return places_->are_known(); }

std::uint64_t ChunkReader::held_bytes() const { return places_->held_bytes() + array_.store->held_bytes(); }

void ChunkReader::decode(std::vector<std::byte> stored, const ChunkIndex& index, const std::string& path,
                         Chunk& chunk) const {
  chunk.shape = array_.block_headers ? take_block_shape(stored, array_, path)
                : array_.precomputed ? shape_inside(index, array_)
                                     : array_.chunk;
  std::vector<Codec> codecs = array_.codecs;
  if (array_.precomputed && path.ends_with(kPackedEnding)) codecs.insert(codecs.begin(), Codec::kDeflate);
  if (array_.precomputed && array_.precomputed->segmentation_block[0] > 0) {
    stored = undo_codecs(std::move(stored), codecs, to_size(most_chunk_bytes(array_)), path);
    chunk.samples = decode_segmentation(stored, segmentation_shape(chunk.shape, array_), path);
    return;
  }
  chunk.samples = decode_chunk(std::move(stored), codecs, sample_count(chunk.shape) * sample_bytes(array_.type), path);
}

void ChunkReader::expect(const std::vector<ChunkIndex>& next, const std::vector<ChunkIndex>& later) {
  std::vector<ObjectPart> parts;
  for (const std::vector<ChunkIndex>* const chunks : {&next, &later}) {
    for (const ChunkIndex& index : *chunks) {
      if (std::optional<ObjectPart> place = places_->find(index)) parts.push_back(std::move(*place));
    }
  }
  array_.store->expect(parts);
}

bool ChunkReader::read(const ChunkIndex& index, Chunk& chunk) {
  std::optional<ObjectPart> place = places_->find(index);
  if (!place) return false;
  std::optional<std::vector<std::byte>> stored = array_.store->read(*place);
  if (!stored && place->whole && array_.precomputed) {
    place->path += kPackedEnding;
    stored = array_.store->read(*place);
  }
  if (!stored && !place->whole) bad_input(place->path, "an object that stays as it is while it is read", "none");
  if (stored && stored->empty()) bad_input(place->path, "a chunk", "no bytes");
  if (stored) decode(std::move(*stored), index, place->path, chunk);
  return stored.has_value();
}

}  // namespace isoweave
