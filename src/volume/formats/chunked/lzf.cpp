// A stream of runs. A byte below 32 is followed by that many bytes and one more, as they are. Any other has in its
// upper three bits the length of a copy less 2, 7 meaning that a byte to be added follows; its lower five bits and the
// next byte are the distance back, less 1.
#include "volume/formats/chunked/lzf.hpp"

#include <cstring>

namespace isoweave {
namespace {

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool ended() const { return at_ == bytes_.size(); }
  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t next() { return std::to_integer<std::size_t>(bytes_[at_++]); }
  const std::byte* take(std::size_t count) {
    at_ += count;
    return bytes_.data() + at_ - count;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace

bool decode_lzf(std::span<const std::byte> stored, std::span<std::byte> out) {
  constexpr std::size_t kPlainRuns = 32;
  constexpr std::size_t kLonger = 7;
  Reader reader(stored);
  std::size_t done = 0;
  while (!reader.ended()) {
    const std::size_t head = reader.next();
    if (head < kPlainRuns) {
      const std::size_t count = head + 1;
      if (count > reader.left() || count > out.size() - done) return false;
      std::memcpy(out.data() + done, reader.take(count), count);
      done += count;
      continue;
    }
    std::size_t count = (head >> 5) + 2;
    if (reader.left() < (head >> 5 == kLonger ? 2U : 1U)) return false;
    if (head >> 5 == kLonger) count += reader.next();
    const std::size_t distance = ((head & 31) << 8) + reader.next() + 1;
    if (distance > done || count > out.size() - done) return false;
    // The copy may reach into what it writes.
    for (std::size_t n = 0; n < count; ++n, ++done) out[done] = out[done - distance];
  }
  return done == out.size();
}

}  // namespace isoweave
