#include "volume/formats/dicom/jpeg_entropy.hpp"

namespace isoweave {
namespace {

constexpr std::byte kOnes{0xff};

}  // namespace

bool HuffmanCode::define(std::span<const std::byte, kLongest> counts, std::span<const std::byte> symbols) {
  symbols_.clear();
  for (const std::byte symbol : symbols) symbols_.push_back(std::to_integer<std::uint8_t>(symbol));
  quick_ = {};
  std::uint32_t code = 0;
  std::size_t place = 0;
  for (int length = 1; length <= kLongest; ++length, code <<= 1) {
    const auto n = static_cast<std::size_t>(length);
    const auto count = std::to_integer<std::uint32_t>(counts[n - 1]);
    if (code + count > 1U << length || place + count > symbols_.size()) return false;
    offset_[n] = static_cast<std::int32_t>(place) - static_cast<std::int32_t>(code);
    for (const std::uint32_t end = code + count; code < end; ++code, ++place) {
      if (length > kQuick) continue;
      const std::uint32_t first = code << (kQuick - length);
      for (std::uint32_t tail = 0; tail < 1U << (kQuick - length); ++tail) {
        quick_[first + tail] = {symbols_[place], static_cast<std::uint8_t>(length)};
      }
    }
    end_[n] = code << (kLongest - length);
  }
  return place == symbols_.size();
}

HuffmanCode::Match HuffmanCode::match(std::uint32_t bits) const {
  const Match quick = quick_[bits >> (kLongest - kQuick)];
  if (quick.length > 0) return quick;
  for (int length = kQuick + 1; length <= kLongest; ++length) {
    const auto n = static_cast<std::size_t>(length);
    if (bits >= end_[n]) continue;
    const auto place = static_cast<std::int32_t>(bits >> (kLongest - length)) + offset_[n];
    return {symbols_[static_cast<std::size_t>(place)], static_cast<std::uint8_t>(length)};
  }
  return {};
}

int JpegBits::symbol(const HuffmanCode& code) {
  fill();
  const HuffmanCode::Match match = code.match(static_cast<std::uint32_t>(bits_ >> 48));
  if (match.length == 0) failed_ = true;
  take(match.length);
  return match.symbol;
}

int JpegBits::number(int bits) {
  if (bits == 0) return 0;
  fill();
  const auto value = static_cast<int>(take(bits));
  return value < 1 << (bits - 1) ? value - (1 << bits) + 1 : value;
}

void JpegBits::restart(std::uint32_t n) {
  constexpr std::uint32_t kFirstRestart = 0xd0;
  constexpr std::size_t kMarker = 2;
  bits_ = 0;
  count_ = 0;
  while (at_ + 1 < stream_.size() && stream_[at_] == kOnes && stream_[at_ + 1] == kOnes) ++at_;  // filling
  const bool there = stream_.size() - at_ >= kMarker && stream_[at_] == kOnes &&
                     std::to_integer<std::uint32_t>(stream_[at_ + 1]) == kFirstRestart + n % 8;
  if (!there) failed_ = true;
  if (there) at_ += kMarker;
}

// Up to the next marker. A byte of ones is followed by one of zeros where it is none.
void JpegBits::fill() {
  constexpr int kRoom = 64 - 8;
  while (count_ <= kRoom && at_ < stream_.size()) {
    const std::byte byte = stream_[at_];
    const bool ones = byte == kOnes;
    if (ones && (at_ + 1 >= stream_.size() || stream_[at_ + 1] != std::byte{0})) return;
    bits_ |= std::to_integer<std::uint64_t>(byte) << (kRoom - count_);
    count_ += 8;
    at_ += ones ? 2 : 1;
  }
}

std::uint32_t JpegBits::take(int bits) {
  if (bits == 0) return 0;
  if (bits > count_) failed_ = true;
  const auto value = static_cast<std::uint32_t>(bits_ >> (64 - bits));
  bits_ <<= bits;
  count_ = count_ > bits ? count_ - bits : 0;
  return value;
}

}  // namespace isoweave
