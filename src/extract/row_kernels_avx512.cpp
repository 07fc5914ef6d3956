// Compiled for AVX-512, where a comparison gives bits.
#include <immintrin.h>

#include "extract/row_kernels_in_lanes.hpp"

namespace isoweave {
namespace {

struct MaskLanes {
  template <class T, bool kAbove>
  static std::uint64_t compare(const T* samples, T threshold) {
    using Vector [[gnu::vector_size(64), gnu::aligned(alignof(T)), gnu::may_alias]] = T;
    constexpr int kCount = 64 / sizeof(T);
    std::uint64_t word = 0;
    for (int n = 0; n < 64; n += kCount) {
      const Vector vector = *reinterpret_cast<const Vector*>(samples + n);
      word |= bits<T>(kAbove ? vector >= threshold : vector <= threshold) << n;
    }
    return word;
  }

 private:
  template <class T, class Lanes>
  static std::uint64_t bits(Lanes lanes) {
    const auto whole = reinterpret_cast<__m512i>(lanes);
    if constexpr (sizeof(T) == 1) return _mm512_movepi8_mask(whole);
    if constexpr (sizeof(T) == 2) return _mm512_movepi16_mask(whole);
    if constexpr (sizeof(T) == 4) return _mm512_movepi32_mask(whole);
    if constexpr (sizeof(T) == 8) return _mm512_movepi64_mask(whole);
  }
};

}  // namespace

const RowKernels& avx512_row_kernels() {
  static constexpr RowKernels kTable = RowKernelsInLanes<MaskLanes>::table();
  return kTable;
}

}  // namespace isoweave
