// The finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection of 64-bit words in which every input bit reaches
// every output bit. It serves as a hash and, over a counter, as a source of random numbers without state.
#pragma once

#include <cstdint>

namespace isoweave::measure {

constexpr std::uint64_t splitmix64(std::uint64_t word) {
  word += 0x9e3779b97f4a7c15u;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9u;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebu;
  return word ^ (word >> 31);
}

}  // namespace isoweave::measure
