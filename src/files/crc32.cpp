#include "files/crc32.hpp"

#include <array>

namespace isoweave {
namespace {

constexpr std::uint32_t kPolynomial = 0xedb88320U;  // without x^32, the bit of x^0 on the left
constexpr std::uint32_t kOne = 0x80000000U;
constexpr std::size_t kAtOnce = 16;

using Table = std::array<std::uint32_t, 256>;

constexpr std::uint32_t times_x(std::uint32_t a) { return (a >> 1) ^ ((a & 1) != 0 ? kPolynomial : 0); }

// The n-th table: the CRC of a byte that n bytes follow (Kounavis and Berry 2005, slicing).
constexpr std::array<Table, kAtOnce> make_tables() {
  std::array<Table, kAtOnce> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = times_x(crc);
    tables[0][byte] = crc;
  }
  for (std::size_t n = 1; n < kAtOnce; ++n) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[n - 1][byte];
      tables[n][byte] = (before >> 8) ^ tables[0][before & 0xff];
    }
  }
  return tables;
}

constexpr std::array<Table, kAtOnce> kTables = make_tables();

std::uint32_t product(std::uint32_t a, std::uint32_t b) {
  std::uint32_t sum = 0;
  for (std::uint32_t bit = kOne; bit != 0; bit >>= 1) {
    if ((a & bit) != 0) sum ^= b;
    b = times_x(b);
  }
  return sum;
}

// x to the power of eight times so many bytes.
std::uint32_t shift_of(std::uint64_t bytes) {
  std::uint32_t power = kOne;
  std::uint32_t square = kOne >> 8;  // x^8, then its squares
  for (; bytes > 0; bytes >>= 1) {
    if ((bytes & 1) != 0) power = product(power, square);
    square = product(square, square);
  }
  return power;
}

}  // namespace

std::uint32_t add_to_crc(std::uint32_t crc, std::span<const std::byte> bytes) {
  crc = ~crc;
  std::size_t at = 0;
  for (; bytes.size() - at >= kAtOnce; at += kAtOnce) {
    std::uint32_t next = 0;
    for (std::size_t n = 0; n < kAtOnce; ++n) {
      const std::uint32_t before = n < 4 ? (crc >> (8 * n)) & 0xff : 0;
      next ^= kTables[kAtOnce - 1 - n][std::to_integer<std::uint32_t>(bytes[at + n]) ^ before];
    }
    crc = next;
  }
  for (; at < bytes.size(); ++at) {
    crc = (crc >> 8) ^ kTables[0][(crc ^ std::to_integer<std::uint32_t>(bytes[at])) & 0xff];
  }
  return ~crc;
}

std::uint32_t join_crcs(std::uint32_t first, std::uint32_t second, std::uint64_t second_bytes) {
  return product(shift_of(second_bytes), first) ^ second;
}

}  // namespace isoweave
