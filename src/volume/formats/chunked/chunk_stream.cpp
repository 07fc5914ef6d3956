// Volumes from chunks: a band of slices as deep as a chunk is put together at a time.
#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/input_file.hpp"
#include "volume/band_stream.hpp"
#include "volume/formats/chunked/chunked_array.hpp"
#include "volume/half_floats.hpp"

namespace isoweave {
namespace {

namespace fs = std::filesystem;

// Samples [begin, end) of an axis of the volume, all in one chunk.
struct Piece {
  std::int64_t chunk = 0;
  std::int64_t begin = 0;
  std::int64_t end = 0;
  std::int64_t shard = 0;
};

// The part of a chunk that lies in a band, by its pieces along i, j and k.
using ChunkPart = std::array<Piece, 3>;

Region box_of(const ChunkPart& part) {
  const auto& [i, j, k] = part;
  return {{i.begin, j.begin, k.begin}, {i.end, j.end, k.end}};
}

// Calls visit for every run of pieces that lie in one shard.
template <class Visit>
void for_shards(std::span<const Piece> pieces, const Visit& visit) {
  while (!pieces.empty()) {
    const auto other = [shard = pieces.front().shard](const Piece& piece) { return piece.shard != shard; };
    const auto end = std::find_if(pieces.begin(), pieces.end(), other);
    const auto count = static_cast<std::size_t>(end - pieces.begin());
    visit(pieces.first(count));
    pieces = pieces.subspan(count);
  }
}

class ChunkStream final : public BandStream {
 public:
  ChunkStream(const ChunkedArray& array, const VolumeInfo& info, AxisChoice choice, std::int64_t depth,
              std::shared_ptr<Gaps> gaps)
      : BandStream(info.dims[2], info.slice_bytes(), depth),
        gaps_(std::move(gaps)),
        reader_(array),
        choice_(std::move(choice)),
        dims_(info.dims),
        box_{{0, 0, 0}, info.dims},
        depth_(depth),
        bytes_each_(sample_bytes(info.type)) {}

  std::uint64_t held_by_reader() const { return reader_.held_bytes(); }

  bool narrows() const override { return true; }
  void narrow(const Region& box) override {
    box_ = box;
    const auto bytes_of = [&](std::int64_t samples) { return static_cast<std::uint64_t>(samples) * bytes_each_; };
    keep({bytes_of(dims_[0]), static_cast<std::uint64_t>(box.first[1]), static_cast<std::uint64_t>(side(1)),
          bytes_of(box.first[0]), bytes_of(side(0))});
  }

 protected:
  void fill(std::int64_t first, std::int64_t count, std::span<std::byte> band) override {
    put_fill_value(band);
    if (reader_.looks_ahead()) return fill_ahead(first, first + count, band);
    for_parts(first, first + count, [&](const ChunkPart& part) {
      if (!gaps_->leaves_out(box_of(part))) put_chunk(part, band);
    });
  }

 private:
  std::int64_t side(std::size_t axis) const { return box_.end[axis] - box_.first[axis]; }

  // Chunks whose places are looked up before any of them is read: the indices of their shards are held meanwhile.
  static constexpr std::size_t kTogether = 64;

  // Fills a band while chunks that come later are asked for.
  void fill_ahead(std::int64_t first, std::int64_t end, std::span<std::byte> band) {
    std::vector<ChunkPart> parts = parts_of_band(first, end);
    std::erase_if(parts, [this](const ChunkPart& part) { return gaps_->leaves_out(box_of(part)); });
    const std::vector<ChunkIndex> later = chunks_behind(end);
    const std::size_t together = reader_.knows_places() ? parts.size() : kTogether;
    for (std::size_t n = 0; n < parts.size(); ++n) {
      if (n % together == 0) {
        reader_.expect(indices_of(std::span(parts).subspan(n, std::min(together, parts.size() - n))), later);
      }
      put_chunk(parts[n], band);
    }
  }

  std::vector<ChunkPart> parts_of_band(std::int64_t first, std::int64_t end) const {
    std::vector<ChunkPart> parts;
    for_parts(first, end, [&](const ChunkPart& part) { parts.push_back(part); });
    return parts;
  }

  // Visits the chunks of a band, those of a shard one after another: its index is read once for the band.
  template <class Visit>
  void for_parts(std::int64_t first, std::int64_t end, const Visit& visit) const {
    const Piece k = pieces(2, first, end).front();
    const std::vector<Piece> rows = pieces(1, box_.first[1], box_.end[1]);
    const std::vector<Piece> columns = pieces(0, box_.first[0], box_.end[0]);
    for_shards(rows, [&](std::span<const Piece> in_rows) {
      for_shards(columns, [&](std::span<const Piece> in_columns) {
        for (const Piece& j : in_rows) {
          for (const Piece& i : in_columns) visit(ChunkPart{i, j, k});
        }
      });
    });
  }

  // The chunks that are needed of the band that begins at a slice.
  std::vector<ChunkIndex> chunks_behind(std::int64_t first) const {
    if (!reader_.knows_places() || first >= dims_[2]) return {};
    std::vector<ChunkPart> parts = parts_of_band(first, std::min(first + depth_, dims_[2]));
    const NeededSamples* const needed = gaps_->needed;
    if (needed != nullptr) std::erase_if(parts, [&](const ChunkPart& part) { return !needed->any_in(box_of(part)); });
    return indices_of(parts);
  }

  std::vector<ChunkIndex> indices_of(std::span<const ChunkPart> parts) const {
    std::vector<ChunkIndex> indices;
    for (const ChunkPart& part : parts) indices.push_back(index_of(part));
    return indices;
  }

  ChunkIndex index_of(const ChunkPart& part) const {
    const ChunkedArray& array = reader_.array();
    ChunkIndex index(array.axes.size());
    for (std::size_t n = 0; n < index.size(); ++n) index[n] = choice_.at[n] / array.chunk[n];
    for (std::size_t a = 0; a < 3; ++a) {
      if (choice_.axis.at(a) != kNoAxis) index[choice_.axis.at(a)] = part.at(a).chunk;
    }
    return index;
  }

  void put_fill_value(std::span<std::byte> band) const {
    const auto& value = reader_.array().fill;
    if (value == std::array<std::byte, 8>{}) {
      std::fill(band.begin(), band.end(), std::byte{0});
      return;
    }
    for (std::size_t at = 0; at < band.size(); at += bytes_each_) std::memcpy(&band[at], value.data(), bytes_each_);
  }

  // Cuts [first, end) of axis `a` of the volume at the borders of chunks.
  std::vector<Piece> pieces(std::size_t a, std::int64_t first, std::int64_t end) const {
    const std::size_t axis = choice_.axis.at(a);
    if (axis == kNoAxis) return {{0, first, end, 0}};
    const ChunkedArray& array = reader_.array();
    const std::int64_t step = array.chunk[axis];
    const std::int64_t in_shard = array.shards ? array.shards->chunks[axis] : 1;
    std::vector<Piece> pieces;
    for (std::int64_t begin = first; begin < end;) {
      const std::int64_t chunk = begin / step;
      const std::int64_t stop = std::min(end, step * (chunk + 1));
      pieces.push_back({chunk, begin, stop, chunk / in_shard});
      begin = stop;
    }
    return pieces;
  }

  // Samples from one sample of a stored chunk to the next along each axis of the array.
  std::vector<std::int64_t> steps_of(const Chunk& chunk) const {
    std::vector<std::int64_t> steps(chunk.shape.size());
    std::int64_t step = 1;
    const std::vector<std::size_t>& order = reader_.array().stored_order;
    for (std::size_t n = order.size(); n-- > 0;) {
      steps[order[n]] = step;
      step *= chunk.shape[order[n]];
    }
    return steps;
  }

  void put_chunk(const ChunkPart& place, std::span<std::byte> band) {
    const ChunkedArray& array = reader_.array();
    const ChunkIndex index = index_of(place);
    if (!reader_.read(index, chunk_)) return;
    const std::vector<std::int64_t> steps = steps_of(chunk_);
    std::int64_t from = 0;
    for (std::size_t n = 0; n < index.size(); ++n) {
      const std::int64_t inside = choice_.at[n] % array.chunk[n];
      if (inside >= chunk_.shape[n]) return;
      from += inside * steps[n];
    }
    BlockCopy copy;
    copy.to_step = {1, side(0), side(0) * side(1)};
    const std::int64_t to = place[0].begin - box_.first[0] + (place[1].begin - box_.first[1]) * side(0);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t axis = choice_.axis.at(a);
      if (axis == kNoAxis) continue;
      // Bands begin where chunks do, boxes anywhere.
      const std::int64_t inside = place.at(a).begin - place.at(a).chunk * array.chunk[axis];
      copy.size.at(a) = std::min(place.at(a).end - place.at(a).begin, chunk_.shape[axis] - inside);
      if (copy.size.at(a) <= 0) return;
      copy.from_step.at(a) = steps[axis];
      from += inside * steps[axis];
    }
    const auto bytes = static_cast<std::int64_t>(bytes_each_);
    copy_block(chunk_.samples.data() + from * bytes, band.data() + to * bytes, copy, bytes_each_);
  }

  std::shared_ptr<Gaps> gaps_;
  ChunkReader reader_;
  AxisChoice choice_;
  std::array<std::int64_t, 3> dims_;
  Region box_;  // that is read
  std::int64_t depth_;
  std::size_t bytes_each_;
  Chunk chunk_;
};

// Bytes of the files in a folder, counted until they are `enough`.
std::uint64_t bytes_below(const std::string& folder, std::uint64_t enough) {
  std::uint64_t bytes = 0;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && bytes < enough && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) bytes += entry->file_size(ignored);
  }
  return bytes;
}

// Whether there is any file or folder that may be a chunk's, where folders can be listed.
bool has_chunks(const ChunkedArray& array) {
  if (!array.store->is_local()) return true;
  std::error_code error;
  fs::directory_iterator entry(array.folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name[0] == 'c' || (name[0] >= '0' && name[0] <= '9')) return true;
  }
  return false;
}

// The bytes of one decoded chunk.
std::uint64_t chunk_bytes(const ChunkedArray& array) {
  std::uint64_t bytes = sample_bytes(array.type);
  for (const std::int64_t size : array.chunk) bytes *= static_cast<std::uint64_t>(size);
  return bytes;
}

// Chunks may be left out, so that any size may be claimed; what is held must be in some proportion to what is stored.
void check_band(const ChunkedArray& array, std::int64_t slices, std::size_t slice_bytes) {
  constexpr std::uint64_t kRatio = 1 << 20;
  std::uint64_t band = 0;
  const bool overflow = __builtin_mul_overflow(static_cast<std::uint64_t>(slices), slice_bytes, &band);
  if (overflow) bad_input(array.header, "bands of slices of fewer than 2^63 bytes", "larger ones");
  if (array.store->is_local()) check_plausible(array.header, band, bytes_below(array.folder, band / kRatio), kRatio);
}

}  // namespace

void check_array(const ChunkedArray& array) {
  const std::string& path = array.header;
  const std::size_t axes = array.axes.size();
  if (axes > kMostAxes) bad_input(path, "at most " + std::to_string(kMostAxes) + " axes", std::to_string(axes));
  if (array.chunk.size() != axes) {
    bad_input(path, "chunks of " + std::to_string(axes) + " axes", std::to_string(array.chunk.size()));
  }
  constexpr std::int64_t kMostSamples = std::int64_t{1} << 40;
  std::int64_t samples = 1;
  for (const std::int64_t size : array.chunk) {
    if (size < 1 || __builtin_mul_overflow(samples, size, &samples) || samples > kMostSamples) {
      bad_input(path, "chunks of 1 to 2^40 samples", "a size of " + std::to_string(size) + " among theirs");
    }
  }
  if (!array.shards) return;
  std::int64_t chunks = 1;
  for (const std::int64_t count : array.shards->chunks) {
    if (count < 1 || __builtin_mul_overflow(chunks, count, &chunks) || chunks > kMostSamples) {
      bad_input(path, "shards of 1 to 2^40 chunks", std::to_string(count) + " along an axis");
    }
  }
}

OpenedVolume open_chunks(const ChunkedArray& array, const AxisChoice& choice) {
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = array.header;
  info.header = array.header;
  info.format = array.format;
  info.type = array.type;
  info.dims = choice.dims(array.axes);
  info.part = choice.part;
  info.notes = array.notes;
  info.notes.insert(info.notes.end(), choice.notes.begin(), choice.notes.end());
  const bool stored = has_chunks(array);
  if (!stored) info.notes.emplace_back("no chunk is stored: every sample is the fill value");
  checked_volume_bytes(info);
  const std::int64_t depth = choice.axis[2] == kNoAxis ? 1 : array.chunk[choice.axis[2]];
  check_band(array, std::min(depth, info.dims[2]), info.slice_bytes());
  volume.swap_bytes = array.big_endian != (std::endian::native == std::endian::big);
  if (!stored) volume.constant = array.fill;
  volume.gaps = std::make_shared<Gaps>();
  auto samples = std::make_unique<ChunkStream>(array, info, choice, depth, volume.gaps);
  volume.held_bytes = samples->held_bytes() + 2 * chunk_bytes(array) + samples->held_by_reader();
  volume.bands = samples.get();
  volume.samples = std::move(samples);
  if (array.is_half) read_halves(volume);
  return volume;
}

}  // namespace isoweave
