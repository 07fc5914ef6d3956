// Compiled for AVX-512 with the tables of bytes (VBMI) and the counts of bits (VPOPCNTDQ) that came with Ice Lake and
// Zen 4: all cases of a word at once, all numbers of a cell at once.
#include <immintrin.h>

#include <bit>

#include "extract/cell_kernels.hpp"

namespace isoweave {
namespace {

constexpr std::array<std::uint8_t, 256> kTriangles = [] {
  std::array<std::uint8_t, 256> counts{};
  for (std::size_t cell = 0; cell < counts.size(); ++cell) counts[cell] = kCaseTable[cell].triangles;
  return counts;
}();

// The cases of the cells of word w, one byte each, as cell_case() gives them.
__m512i cases_of(const CellRow& row, std::size_t w) {
  __m512i cases = _mm512_setzero_si512();
  for (std::size_t r = 0; r < 4; ++r) {
    const std::uint64_t here = row.inside[r][w];
    const std::uint64_t next = here >> 1 | (w + 1 < row.words ? row.inside[r][w + 1] << 63 : 0);
    cases = _mm512_or_si512(cases, _mm512_maskz_set1_epi8(here, static_cast<char>(1 << (2 * r))));
    cases = _mm512_or_si512(cases, _mm512_maskz_set1_epi8(next, static_cast<char>(2 << (2 * r))));
  }
  return cases;
}

__m512i quarter_of_counts(std::size_t quarter) { return _mm512_loadu_si512(kTriangles.data() + 64 * quarter); }

std::uint32_t count_triangles(const CellRow& row) {
  __m512i sum = _mm512_setzero_si512();
  for (std::size_t w = 0; w < row.words; ++w) {
    if (row.crossed[w] == 0) continue;
    const __m512i cases = cases_of(row, w);
    const __m512i low = _mm512_permutex2var_epi8(quarter_of_counts(0), cases, quarter_of_counts(1));
    const __m512i high = _mm512_permutex2var_epi8(quarter_of_counts(2), cases, quarter_of_counts(3));
    const __m512i counts = _mm512_mask_blend_epi8(_mm512_movepi8_mask(cases), low, high);
    sum = _mm512_add_epi64(sum, _mm512_sad_epu8(_mm512_maskz_mov_epi8(row.crossed[w], counts), _mm512_setzero_si512()));
  }
  return static_cast<std::uint32_t>(_mm512_reduce_add_epi64(sum));
}

__m512i crossings_of(const CellRow& row, std::size_t w) {
  const auto word = [&](std::size_t r) { return static_cast<long long>(row.crossings[r][w]); };
  return _mm512_setr_epi64(word(0), word(1), word(2), word(3), word(4), word(5), word(6), word(7));
}

// The numbers of the first crossings of word w. Crossings along y are numbered behind those along x, by the first and
// the third row.
__m512i bases_of(const CellRow& row, std::size_t w, __m512i crossings) {
  const auto x = [&](std::size_t r) { return static_cast<long long>(row.x_base[r][w]); };
  const auto z = [&](std::size_t r) { return static_cast<long long>(row.z_base[r][w]); };
  const __m512i first = _mm512_setr_epi64(x(0), x(1), x(2), x(3), x(0), x(2), z(0), z(1));
  const __m512i before =
      _mm512_maskz_permutexvar_epi64(0x30, _mm512_setr_epi64(0, 0, 0, 0, 0, 2, 0, 0), _mm512_popcnt_epi64(crossings));
  return _mm512_add_epi64(first, before);
}

void write_triangles(const CellRow& row, std::size_t w, std::span<std::array<std::uint32_t, 3>> triangles,
                     std::span<std::uint8_t, 64> cases_crossed) {
  std::array<std::uint32_t, 3>* out = triangles.data();
  std::uint8_t* next_case = cases_crossed.data();
  alignas(64) std::array<std::uint8_t, 64> cases;
  _mm512_store_si512(cases.data(), cases_of(row, w));
  const __m512i crossings = crossings_of(row, w);
  __m512i next = bases_of(row, w, crossings);
  for (std::uint64_t crossed = row.crossed[w]; crossed != 0; crossed &= crossed - 1) {
    const int bit = std::countr_zero(crossed);
    const std::uint8_t cell = cases[static_cast<std::size_t>(bit)];
    *next_case++ = cell;
    const __m512i own = _mm512_and_si512(_mm512_srl_epi64(crossings, _mm_cvtsi32_si128(bit)), _mm512_set1_epi64(1));
    const __m512i here = next;
    next = _mm512_add_epi64(here, own);
    if (bit == 63 && w + 1 < row.words) next = bases_of(row, w + 1, crossings_of(row, w + 1));
    const __m512i numbers =
        _mm512_inserti32x8(_mm512_castsi256_si512(_mm512_cvtepi64_epi32(here)), _mm512_cvtepi64_epi32(next), 1);
    const __m512i places =
        _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(kCornerPlaces[cell].data())));
    const auto corners = static_cast<__mmask16>((1U << 3 * kTriangles[cell]) - 1);
    _mm512_mask_storeu_epi32(out, corners, _mm512_permutexvar_epi32(places, numbers));
    out += kTriangles[cell];
  }
}

}  // namespace

const CellKernels& avx512_cell_kernels() {
  static constexpr CellKernels kTable{count_triangles, write_triangles};
  return kTable;
}

}  // namespace isoweave
