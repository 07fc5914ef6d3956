// Compiled for AVX2, where bits are gathered from the signs of lanes.
#include <immintrin.h>

#include "extract/row_kernels_in_lanes.hpp"

namespace isoweave {
namespace {

struct SignLanes {
  template <class T, bool kAbove>
  static std::uint64_t compare(const T* samples, T threshold) {
    constexpr int kCount = 32 / sizeof(T);
    std::uint64_t word = 0;
    if constexpr (sizeof(T) == 2) {
      for (int n = 0; n < 64; n += 32) {
        const __m256i first = lanes<T, kAbove>(samples + n, threshold);
        const __m256i second = lanes<T, kAbove>(samples + n + kCount, threshold);
        // Halves are packed one by one: their order is put right.
        const __m256i bytes = _mm256_permute4x64_epi64(_mm256_packs_epi16(first, second), 0b11'01'10'00);
        word |= std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_epi8(bytes))} << n;
      }
      return word;
    }
    for (int n = 0; n < 64; n += kCount) {
      word |= std::uint64_t{signs<sizeof(T)>(lanes<T, kAbove>(samples + n, threshold))} << n;
    }
    return word;
  }

 private:
  // All bits of a lane are set where its sample is at the threshold or above it (or at it or below).
  template <class T, bool kAbove>
  static __m256i lanes(const T* samples, T threshold) {
    using Vector [[gnu::vector_size(32), gnu::aligned(alignof(T)), gnu::may_alias]] = T;
    const Vector vector = *reinterpret_cast<const Vector*>(samples);
    return reinterpret_cast<__m256i>(kAbove ? vector >= threshold : vector <= threshold);
  }

  template <std::size_t kBytes>
  static std::uint32_t signs(__m256i lanes) {
    if constexpr (kBytes == 1) return static_cast<std::uint32_t>(_mm256_movemask_epi8(lanes));
    if constexpr (kBytes == 4) return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(lanes)));
    return static_cast<std::uint32_t>(_mm256_movemask_pd(_mm256_castsi256_pd(lanes)));
  }
};

}  // namespace

const RowKernels& avx2_row_kernels() {
  static constexpr RowKernels kTable = RowKernelsInLanes<SignLanes>::table();
  return kTable;
}

}  // namespace isoweave
