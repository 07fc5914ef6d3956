// MurmurHash3 by Austin Appleby, in the public domain: its variant of 128 bits for processors of 32.
#include "files/murmur_hash.hpp"

#include <array>
#include <bit>

namespace isoweave {
namespace {

std::uint32_t mixed(std::uint32_t h) {
  h = (h ^ (h >> 16U)) * 0x85ebca6bU;
  h = (h ^ (h >> 13U)) * 0xc2b2ae35U;
  return h ^ (h >> 16U);
}

}  // namespace

// Eight bytes are less than a block: what the original calls the tail is all there is.
std::uint64_t murmur_hash(std::uint64_t number) {
  constexpr std::uint32_t kBytes = 8;
  constexpr std::uint32_t kC1 = 0x239b961b, kC2 = 0xab0e9789, kC3 = 0x38b34ae5;
  const auto low = static_cast<std::uint32_t>(number), high = static_cast<std::uint32_t>(number >> 32U);
  std::array<std::uint32_t, 4> h{std::rotl(low * kC1, 15) * kC2, std::rotl(high * kC2, 16) * kC3, 0, 0};
  for (std::uint32_t& word : h) word ^= kBytes;
  const auto spread = [&h] {
    h[0] += h[1] + h[2] + h[3];
    for (std::size_t n = 1; n < h.size(); ++n) h.at(n) += h[0];
  };
  spread();
  for (std::uint32_t& word : h) word = mixed(word);
  spread();
  return std::uint64_t{h[1]} << 32U | h[0];
}

}  // namespace isoweave
