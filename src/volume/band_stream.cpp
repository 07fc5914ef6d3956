#include "volume/band_stream.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "parallel/size.hpp"

namespace isoweave {

BandStream::BandStream(std::int64_t slices, std::size_t slice_bytes, std::int64_t depth)
    : slices_(slices), slice_bytes_(slice_bytes), depth_(std::min(depth, slices)) {}

std::uint64_t BandStream::band_bytes(std::int64_t band) const {
  const std::int64_t first = band * depth_;
  return first >= slices_ ? 0 : static_cast<std::uint64_t>(std::min(depth_, slices_ - first)) * slice_bytes_;
}

void BandStream::fill_band(std::span<std::byte> band) {
  const std::int64_t first = band_ * depth_;
  fill(first, std::min(depth_, slices_ - first), band);
}

void BandStream::fill_buffer() {
  if (filled_) return;
  buffer_.resize(to_size(band_bytes(band_) / slice_bytes_ * kept_slice()));
  fill_band(buffer_);
  filled_ = true;
}

std::size_t BandStream::read_in_window(std::span<std::byte> out) {
  if (band_bytes(band_) == 0) return 0;
  fill_buffer();
  const std::uint64_t slice = used_ / slice_bytes_;
  const std::uint64_t row = used_ % slice_bytes_ / window_->row_bytes - window_->first_row;
  const std::uint64_t byte = used_ % window_->row_bytes - window_->first_byte;
  if (row >= window_->rows || byte > window_->bytes || out.size() > window_->bytes - byte) {
    throw std::logic_error("samples beside the box that is kept of a volume");
  }
  const std::uint64_t from = slice * window_->slice_bytes() + row * window_->bytes + byte;
  std::memcpy(out.data(), buffer_.data() + from, out.size());
  advance(out.size());
  return out.size();
}

void BandStream::advance(std::uint64_t bytes) {
  used_ += bytes;
  if (used_ < band_bytes(band_)) return;
  ++band_;
  used_ = 0;
  filled_ = false;
}

std::size_t BandStream::read(std::span<std::byte> out) {
  if (window_) return read_in_window(out);
  std::size_t done = 0;
  while (done < out.size() && band_bytes(band_) > 0) {
    const std::size_t whole = to_size(band_bytes(band_));
    const std::size_t step = std::min(out.size() - done, whole - static_cast<std::size_t>(used_));
    if (!filled_ && step == whole) {
      fill_band(out.subspan(done, whole));
    } else {
      fill_buffer();
      std::memcpy(out.data() + done, buffer_.data() + used_, step);
    }
    done += step;
    advance(step);
  }
  return done;
}

std::uint64_t BandStream::skip(std::uint64_t count) {
  std::uint64_t done = 0;
  while (done < count && band_bytes(band_) > 0) {
    const std::uint64_t step = std::min(count - done, band_bytes(band_) - used_);
    done += step;
    advance(step);
  }
  return done;
}

namespace {

template <std::size_t kBytes>
void copy_typed(const std::byte* from, std::byte* to, const BlockCopy& copy) {
  constexpr auto kStep = static_cast<std::int64_t>(kBytes);
  for (std::int64_t k = 0; k < copy.size[2]; ++k) {
    for (std::int64_t j = 0; j < copy.size[1]; ++j) {
      const std::byte* source = from + (k * copy.from_step[2] + j * copy.from_step[1]) * kStep;
      std::byte* target = to + (k * copy.to_step[2] + j * copy.to_step[1]) * kStep;
      if (copy.from_step[0] == 1 && copy.to_step[0] == 1) {
        std::memcpy(target, source, static_cast<std::size_t>(copy.size[0]) * kBytes);
        continue;
      }
      for (std::int64_t i = 0; i < copy.size[0]; ++i) {
        std::memcpy(target + i * copy.to_step[0] * kStep, source + i * copy.from_step[0] * kStep, kBytes);
      }
    }
  }
}

}  // namespace

void copy_block(const std::byte* from, std::byte* to, const BlockCopy& copy, std::size_t sample_bytes) {
  switch (sample_bytes) {
    case 1:
      return copy_typed<1>(from, to, copy);
    case 2:
      return copy_typed<2>(from, to, copy);
    case 4:
      return copy_typed<4>(from, to, copy);
    default:
      return copy_typed<8>(from, to, copy);
  }
}

}  // namespace isoweave
