#include "volume/formats/other/run_lengths.hpp"

namespace isoweave {

std::optional<std::uint8_t> ByteReader::next() {
  if (used_ == filled_) {
    filled_ = input_->read(buffer_);
    used_ = 0;
    if (filled_ == 0) return std::nullopt;
  }
  return std::to_integer<std::uint8_t>(buffer_[used_++]);
}

std::optional<std::uint8_t> RunLengths::take(ByteReader& reader) {
  const std::optional<std::uint8_t> byte = reader.next();
  if (byte) ++taken_;
  return byte;
}

std::size_t RunLengths::decode(ByteReader& reader, std::span<std::byte> out) {
  constexpr unsigned kLiteral = 0x80;
  std::size_t done = 0;
  while (done < out.size()) {
    if (left_ == 0) {
      const std::optional<std::uint8_t> head = take(reader);
      if (!head) return done;
      left_ = *head % kLiteral;
      literal_ = *head >= kLiteral;
      if (left_ == 0) continue;
      if (!literal_) {
        const std::optional<std::uint8_t> value = take(reader);
        if (!value) return done;
        value_ = *value;
      }
    }
    if (literal_) {
      const std::optional<std::uint8_t> value = take(reader);
      if (!value) return done;
      value_ = *value;
    }
    out[done++] = std::byte{value_};
    --left_;
  }
  return done;
}

}  // namespace isoweave
