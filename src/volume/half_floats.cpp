#include "volume/half_floats.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

namespace isoweave {
namespace {

constexpr std::string_view kHalfName = "float16";
constexpr std::size_t kHalfBytes = 2, kFloatBytes = 4;

void convert(const std::byte* half, std::byte* value, bool swap) {
  std::uint16_t bits = 0;
  std::memcpy(&bits, half, kHalfBytes);
  const float number = float_of_half(swap ? __builtin_bswap16(bits) : bits);
  std::memcpy(value, &number, kFloatBytes);
}

class HalfStream final : public ByteStream {
 public:
  HalfStream(std::unique_ptr<ByteStream> halves, bool swap) : halves_(std::move(halves)), swap_(swap) {}

  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = hand_out(out);
    done += read_whole(out.subspan(done));
    // The caller asks for less than one float: the rest of it is kept.
    std::array<std::byte, kHalfBytes> half{};
    if (done == out.size() || halves_->read(half) < kHalfBytes) return done;
    convert(half.data(), rest_.data(), swap_);
    used_ = 0;
    return done + hand_out(out.subspan(done));
  }

  std::uint64_t skip(std::uint64_t count) override {
    const auto kept = static_cast<std::size_t>(std::min<std::uint64_t>(count, kFloatBytes - used_));
    used_ += kept;
    const std::uint64_t whole = (count - kept) / kFloatBytes * kHalfBytes;
    const std::uint64_t skipped = whole == 0 ? 0 : halves_->skip(whole);
    const std::uint64_t done = kept + skipped / kHalfBytes * kFloatBytes;
    return skipped < whole || done == count ? done : done + ByteStream::skip(count - done);
  }

  bool skips() const override { return halves_->skips(); }

 private:
  std::size_t hand_out(std::span<std::byte> out) {
    const std::size_t count = std::min(out.size(), kFloatBytes - used_);
    std::copy_n(rest_.begin() + static_cast<std::ptrdiff_t>(used_), count, out.begin());
    used_ += count;
    return count;
  }

  // Halves go into the upper half of the memory, and become floats from its beginning on.
  std::size_t read_whole(std::span<std::byte> out) {
    const std::size_t count = out.size() / kFloatBytes;
    if (count == 0) return 0;
    const std::span<std::byte> stored = out.subspan(count * kHalfBytes, count * kHalfBytes);
    const std::size_t got = halves_->read(stored) / kHalfBytes;
    for (std::size_t n = 0; n < got; ++n) {
      convert(stored.data() + n * kHalfBytes, out.data() + n * kFloatBytes, swap_);
    }
    return got * kFloatBytes;
  }

  std::unique_ptr<ByteStream> halves_;
  bool swap_;
  std::array<std::byte, kFloatBytes> rest_{};
  std::size_t used_ = kFloatBytes;  // of the rest
};

}  // namespace

std::optional<StoredType> parse_stored_type(std::string_view name) {
  if (name == kHalfName) return StoredType{SampleType::kUint16, true};
  const std::optional<SampleType> type = parse_sample_type(name);
  if (!type) return std::nullopt;
  return StoredType{*type};
}

std::string_view stored_type_name(const StoredType& type) {
  return type.is_half ? kHalfName : sample_type_name(type.type);
}

// The sign, five bits of exponent with a bias of 15, ten of mantissa.
float float_of_half(std::uint16_t half) {
  constexpr std::uint32_t kMantissa = 0x3ff, kExponent = 0x1f, kShift = 23 - 10, kBias = 127 - 15;
  const std::uint32_t sign = static_cast<std::uint32_t>(half >> 15U) << 31U;
  const std::uint32_t exponent = half >> 10U & kExponent;
  const std::uint32_t mantissa = half & kMantissa;
  // Exponents below the least one: a multiple of 2^-24.
  if (exponent == 0) return std::copysign(static_cast<float>(mantissa) * 0x1p-24F, sign == 0 ? 1.0F : -1.0F);
  const std::uint32_t wide = exponent == kExponent ? 0xff : exponent + kBias;
  return std::bit_cast<float>(sign | wide << 23U | mantissa << kShift);
}

std::optional<std::uint16_t> half_of(float value) {
  constexpr std::uint16_t kSign = 0x8000, kNan = 0x7e00, kLargest = 0x7bff;
  constexpr std::uint16_t kHighestBit = 0x4000;
  const std::uint16_t sign = std::signbit(value) ? kSign : 0;
  const float size = std::abs(value);
  if (std::isnan(value)) return kNan;
  if (std::isfinite(value) && size > float_of_half(kLargest)) return std::nullopt;
  // The bits of halves ascend with their values.
  std::uint16_t below = 0;
  for (std::uint16_t bit = kHighestBit; bit > 0; bit = static_cast<std::uint16_t>(bit >> 1U)) {
    const auto tried = static_cast<std::uint16_t>(below | bit);
    if (float_of_half(tried) <= size) below = tried;
  }
  if (float_of_half(below) == size) return static_cast<std::uint16_t>(sign | below);
  const float down = size - float_of_half(below);
  const float up = float_of_half(static_cast<std::uint16_t>(below + 1)) - size;
  const bool rounds_up = up < down || (up == down && below % 2 == 1);
  return static_cast<std::uint16_t>(sign | (below + (rounds_up ? 1 : 0)));
}

void read_halves(OpenedVolume& volume) {
  const bool swap = std::exchange(volume.swap_bytes, false);
  volume.samples = std::make_unique<HalfStream>(std::move(volume.samples), swap);
  volume.info.type = SampleType::kFloat32;
  if (volume.constant) {
    const SampleBytes half = *volume.constant;
    convert(half.data(), volume.constant->data(), swap);
  }
  checked_volume_bytes(volume.info);
}

}  // namespace isoweave
