#include <cstdint>
#include <cstring>

#include "extract/row_kernels_in_lanes.hpp"

namespace isoweave {
namespace {

// Comparisons that the compiler turns into vectors.
struct FlagLanes {
  // Bit i of the result: whether sample i is at the threshold or above it (or at it or below).
  template <class T, bool kAbove>
  static std::uint64_t compare(const T* samples, T threshold) {
    alignas(64) std::uint8_t flags[64];
    for (int i = 0; i < 64; ++i) flags[i] = kAbove ? samples[i] >= threshold : samples[i] <= threshold;
    std::uint64_t word = 0;
    for (int i = 0; i < 8; ++i) word |= packed(flags + 8 * i) << (8 * i);
    return word;
  }

 private:
  // Eight bytes of 0 or 1 to eight bits, by one multiplication.
  static std::uint64_t packed(const std::uint8_t* flags) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, flags, 8);
    return (bytes * 0x0102040810204080u) >> 56;
  }
};

}  // namespace

const RowKernels& portable_row_kernels() {
  static constexpr RowKernels kTable = RowKernelsInLanes<FlagLanes>::table();
  return kTable;
}

}  // namespace isoweave
