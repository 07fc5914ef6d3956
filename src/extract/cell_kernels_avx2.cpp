// Compiled for AVX2 with the shifts of BMI2, which came with Haswell and Zen: all numbers of a cell at once.
#include <immintrin.h>

#include <bit>
#include <cstring>

#include "extract/cell_cases.hpp"

namespace isoweave {
namespace {

std::uint32_t count_triangles(const CellRow& row) { return count_triangles_of_cells(row); }

// The crossings of 32 cells in the eight rows: a half of word w.
__m256i crossings_of(const CellRow& row, std::size_t w, unsigned half) {
  const auto word = [&](std::size_t r) { return static_cast<int>(row.crossings[r][w] >> 32 * half); };
  return _mm256_setr_epi32(word(0), word(1), word(2), word(3), word(4), word(5), word(6), word(7));
}

// The numbers of the first crossings of word w. Crossings along y are numbered behind those along x, by the first and
// the third row.
__m256i bases_of(const CellRow& row, std::size_t w) {
  const auto x = [&](std::size_t r) { return static_cast<int>(row.x_base[r][w]); };
  const auto z = [&](std::size_t r) { return static_cast<int>(row.z_base[r][w]); };
  const auto y = [&](std::size_t r) { return x(r) + std::popcount(row.crossings[r][w]); };
  return _mm256_setr_epi32(x(0), x(1), x(2), x(3), y(0), y(2), z(0), z(1));
}

// The numbers at eight places among sixteen.
__m256i numbers_at(__m128i places, __m256i here, __m256i next) {
  const __m256i place = _mm256_cvtepu8_epi32(places);
  const __m256 first = _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(here, place));
  const __m256 second = _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(next, place));
  const __m256 is_second = _mm256_castsi256_ps(_mm256_slli_epi32(place, 28));  // its sign
  return _mm256_castps_si256(_mm256_blendv_ps(first, second, is_second));
}

void write_triangles(const CellRow& row, std::size_t w, std::span<std::array<std::uint32_t, 3>> triangles,
                     std::span<std::uint8_t, 64> cases) {
  constexpr std::ptrdiff_t kWritten = 16;  // corners at a time, of which the next cell's write over those in excess
  std::uint32_t* out = triangles.data()->data();
  const std::uint32_t* const end = out + 3 * triangles.size();
  std::uint8_t* next_case = cases.data();
  __m256i next = bases_of(row, w);
  for (const unsigned half : {0U, 1U}) {
    const __m256i crossings = crossings_of(row, w, half);
    for_cells(row, w, half, [&](int bit, std::uint32_t cell) {
      *next_case++ = static_cast<std::uint8_t>(cell);
      const __m256i here = next;
      const __m256i own = _mm256_srl_epi32(crossings, _mm_cvtsi32_si128(bit));
      next = _mm256_add_epi32(here, _mm256_and_si256(own, _mm256_set1_epi32(1)));
      if (half == 1 && bit == 31 && w + 1 < row.words) next = bases_of(row, w + 1);
      const __m128i places = _mm_loadu_si128(reinterpret_cast<const __m128i*>(kCornerPlaces[cell].data()));
      const __m256i low = numbers_at(places, here, next);
      const __m256i high = numbers_at(_mm_srli_si128(places, 8), here, next);
      const std::size_t corners = 3U * kCaseTable[cell].triangles;
      if (end - out >= kWritten) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), low);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + 8), high);
      } else {
        alignas(32) std::array<std::uint32_t, kWritten> last;
        _mm256_store_si256(reinterpret_cast<__m256i*>(last.data()), low);
        _mm256_store_si256(reinterpret_cast<__m256i*>(last.data() + 8), high);
        std::memcpy(out, last.data(), corners * sizeof(std::uint32_t));
      }
      out += corners;
    });
  }
}

}  // namespace

const CellKernels& avx2_cell_kernels() {
  static constexpr CellKernels kTable{count_triangles, write_triangles};
  return kTable;
}

}  // namespace isoweave
