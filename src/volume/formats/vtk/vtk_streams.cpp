#include "volume/formats/vtk/vtk_streams.hpp"

#include <algorithm>
#include <utility>

namespace isoweave {
namespace {

// The next `count` bytes of a stream that others read on from.
class PartStream final : public ByteStream {
 public:
  PartStream(std::shared_ptr<ByteStream> input, std::uint64_t count) : input_(std::move(input)), left_(count) {}

  std::size_t read(std::span<std::byte> out) override {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), left_));
    const std::size_t got = input_->read(out.first(wanted));
    left_ -= got;
    return got;
  }

 private:
  std::shared_ptr<ByteStream> input_;
  std::uint64_t left_;
};

// The value of a base64 digit; nothing for padding and for what is no digit.
constexpr std::uint32_t kPadding = 64;
constexpr std::uint32_t kNoDigit = 65;

std::uint32_t digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<std::uint32_t>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<std::uint32_t>(c - 'a' + 26);
  if (c >= '0' && c <= '9') return static_cast<std::uint32_t>(c - '0' + 52);
  if (c == '+') return 62;
  if (c == '/') return 63;
  return c == '=' ? kPadding : kNoDigit;
}

}  // namespace

bool Base64Stream::next_group() {
  std::uint32_t bits = 0;
  std::size_t digits = 0;
  std::size_t padding = 0;
  while (digits + padding < 4) {
    const char c = text_.next();
    if (is_blank(c)) continue;
    if (c == '\0' && digits == 0) return false;
    const std::uint32_t digit = digit_of(c);
    if (digit == kNoDigit || (digit != kPadding && padding > 0) || (digit == kPadding && digits < 2)) {
      bad_input(path_, "groups of four base64 digits", "other characters, or too few");
    }
    bits = bits << 6 | (digit == kPadding ? 0 : digit);
    ++(digit == kPadding ? padding : digits);
  }
  constexpr std::uint32_t kByte = 0xff;
  for (std::size_t n = 0; n < 3; ++n) group_[n] = static_cast<std::byte>(bits >> (16 - 8 * n) & kByte);
  size_ = 3 - padding;
  used_ = 0;
  return true;
}

std::size_t Base64Stream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && (used_ < size_ || next_group())) out[done++] = group_[used_++];
  return done;
}

std::size_t BitStream::read(std::span<std::byte> out) {
  constexpr unsigned kBits = 8;
  std::size_t done = 0;
  for (; done < out.size() && left_ > 0; ++done, --left_) {
    if (bits_ == 0) {
      if (bytes_->read({&byte_, 1}) == 0) break;
      bits_ = kBits;
    }
    --bits_;
    out[done] = byte_ >> bits_ & std::byte{1};
  }
  return done;
}

void BlockStream::enter_block() {
  const bool last = next_ + 1 == sizes_.stored.size() && sizes_.last > 0;
  left_ = last ? sizes_.last : sizes_.block;
  const std::uint64_t stored = sizes_.stored[next_];
  auto part = std::make_unique<PartStream>(input_, stored);
  if (form_ == BlockForm::kLz4) {
    block_ = open_lz4_block(std::move(part), stored, left_, path_);
  } else if (form_ == BlockForm::kLzma) {
    block_ = open_lzma_block(std::move(part), stored, left_, path_);
  } else {
    block_ = std::make_unique<InflateStream>(std::move(part), path_);
  }
  ++next_;
}

void BlockStream::leave_block() {
  // One byte more makes the block check its sum, and must not be there.
  std::array<std::byte, 1> beyond;
  if (block_->read(beyond) != 0) bad_input(path_, "blocks of the size that their header says", "a larger one");
  block_.reset();
}

std::size_t BlockStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && (block_ || next_ < sizes_.stored.size())) {
    if (!block_) enter_block();
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(out.size() - done, left_));
    if (block_->read(out.subspan(done, wanted)) < wanted) {
      bad_input(path_, "blocks of the size that their header says", "a smaller one");
    }
    done += wanted;
    left_ -= wanted;
    if (left_ == 0) leave_block();
  }
  return done;
}

}  // namespace isoweave
