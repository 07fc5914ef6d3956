#include "volume/formats/other/dds_stream.hpp"

#include <algorithm>
#include <utility>

namespace isoweave {
namespace {

constexpr std::size_t kBufferBytes = 16 * 1024;
constexpr std::uint64_t kChunkSamples = 16 * 1024;

}  // namespace

BitReader::BitReader(std::shared_ptr<const InputFile> file, std::uint64_t begin)
    : file_(std::move(file)), position_(begin) {}

void BitReader::refill() {
  buffer_.resize(kBufferBytes);
  buffer_.resize(file_->read_at(position_, buffer_));
  position_ += buffer_.size();
  used_ = 0;
  if (buffer_.empty()) bad_input(file_->path(), "a complete DDS stream", "its end missing");
}

bool BitReader::has(std::uint64_t count) const {
  const std::uint64_t unread = file_->size() - std::min(position_, file_->size());
  return available_ + 8 * (buffer_.size() - used_ + unread) >= count;
}

unsigned BitReader::read(unsigned count) {
  while (available_ < count) {
    if (used_ == buffer_.size()) refill();
    bits_ = (bits_ << 8) | std::to_integer<std::uint64_t>(buffer_[used_++]);
    available_ += 8;
  }
  available_ -= count;
  return static_cast<unsigned>(bits_ >> available_) & ((1u << count) - 1);
}

void BitReader::skip(std::uint64_t count) {
  for (; count > 16; count -= 16) read(16);
  read(static_cast<unsigned>(count));
}

DdsCursor::DdsCursor(const std::shared_ptr<const InputFile>& file, std::uint64_t begin)
    : bits_(file, begin), path_(file->path()), interleave_(bits_.read(2) + 1), strip_(bits_.read(16) + 1) {
  recent_.resize(strip_ + 1);
}

bool DdsCursor::begin_run() {
  // A run of 0 ends the stream. Files that end without one are in use: their writer counts on zeros behind the end.
  constexpr unsigned kCountBits = 7;
  run_left_ = bits_.has(kCountBits) ? bits_.read(kCountBits) : 0;
  if (run_left_ == 0) return false;
  const unsigned code = bits_.read(3);
  run_bits_ = code == 0 ? 0 : code + 1;
  return true;
}

std::uint8_t DdsCursor::next_byte() {
  if (run_left_ == 0 && !begin_run()) bad_input(path_, "more bytes in the DDS stream", "its end");
  --run_left_;
  // All this arithmetic is modulo 256.
  const unsigned difference = bits_.read(run_bits_) - ((1u << run_bits_) >> 1);
  unsigned predicted = recent_[newest_];
  const std::size_t oldest = newest_ == strip_ ? 0 : newest_ + 1;
  if (strip_ > 1 && position_ > strip_) {
    const std::size_t above = oldest == strip_ ? 0 : oldest + 1;
    predicted += recent_[above];
    predicted -= recent_[oldest];
  }
  newest_ = oldest;
  recent_[newest_] = static_cast<std::uint8_t>(predicted + difference);
  ++position_;
  return recent_[newest_];
}

void DdsCursor::read(std::span<std::uint8_t> out) {
  for (std::uint8_t& byte : out) byte = next_byte();
}

void DdsCursor::skip(std::uint64_t count) {
  for (; count > 0; --count) next_byte();
}

std::uint64_t DdsCursor::count_rest() {
  std::uint64_t count = 0;
  do {
    count += run_left_;
    bits_.skip(std::uint64_t{run_left_} * run_bits_);
  } while (begin_run());
  return count;
}

DdsStream::DdsStream(const std::shared_ptr<const InputFile>& file, std::uint64_t begin, std::uint64_t block_samples) {
  cursors_.emplace_back(file, begin);
  interleave_ = cursors_[0].interleave();
  total_ = DdsCursor(cursors_[0]).count_rest();
  block_bytes_ = block_samples == 0 ? std::max<std::uint64_t>(total_, 1) : block_samples * interleave_;
}

// Sets a cursor to the begin of each plane of the next block. The last cursor stands there already.
void DdsStream::begin_block() {
  const std::uint64_t bytes = std::min(block_bytes_, total_ - next_);
  DdsCursor cursor = cursors_.back();
  std::vector<DdsCursor> planes;
  for (std::uint64_t plane = 0; plane < interleave_; ++plane) {
    planes.push_back(cursor);
    const std::uint64_t plane_bytes = (bytes + interleave_ - 1 - plane) / interleave_;
    if (plane + 1 < interleave_) cursor.skip(plane_bytes);
  }
  cursors_ = std::move(planes);
  block_end_ = next_ + bytes;
}

// Merges the next samples of all planes.
void DdsStream::refill() {
  if (next_ == block_end_) begin_block();
  const std::uint64_t bytes = std::min(kChunkSamples * interleave_, block_end_ - next_);
  chunk_.resize(static_cast<std::size_t>(bytes));
  chunk_used_ = chunk_.size();  // nothing to give out unless all planes can be read
  for (std::size_t plane = 0; plane < cursors_.size(); ++plane) {
    plane_.resize((chunk_.size() + cursors_.size() - 1 - plane) / cursors_.size());
    cursors_[plane].read(plane_);
    for (std::size_t n = 0; n < plane_.size(); ++n) chunk_[n * cursors_.size() + plane] = std::byte{plane_[n]};
  }
  next_ += bytes;
  chunk_used_ = 0;
}

std::size_t DdsStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size()) {
    if (chunk_used_ == chunk_.size()) {
      if (next_ == total_) break;
      refill();
    }
    const std::size_t step = std::min(out.size() - done, chunk_.size() - chunk_used_);
    std::copy_n(chunk_.begin() + static_cast<std::ptrdiff_t>(chunk_used_), step,
                out.begin() + static_cast<std::ptrdiff_t>(done));
    chunk_used_ += step;
    done += step;
  }
  return done;
}

}  // namespace isoweave
