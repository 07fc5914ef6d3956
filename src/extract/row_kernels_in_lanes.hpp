// Row kernels by vectors. Each instruction set has a type of lanes of its own, so that no functions of two sets share a
// name.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

#include "extract/row_kernels.hpp"
#include "parallel/prefetch.hpp"

namespace isoweave {

template <class Lanes>
class RowKernelsInLanes {
 public:
  static constexpr RowKernels table() {
    return {{comparison<std::uint8_t>(), comparison<std::int8_t>(), comparison<std::uint16_t>(),
             comparison<std::int16_t>(), comparison<std::uint32_t>(), comparison<std::int32_t>(),
             comparison<std::uint64_t>(), comparison<std::int64_t>(), comparison<float>(), comparison<double>()},
            differ_along,
            differ,
            cells_crossed};
  }

 private:
  template <class T>
  static constexpr Comparison<T> comparison() {
    return {compare<T, true>, compare<T, false>};
  }

  // Samples that are fetched ahead are a page away, where processors do not look by themselves.
  static constexpr std::size_t kAhead = 4096;  // bytes

  // The first and the last word look at 64 samples, too. Some of these samples belong to the words beside them.
  template <class T, bool kAbove>
  static void compare(const T* row, std::int64_t n, T threshold, std::span<std::uint64_t> words) {
    if (n < 64) return compare_few<T, kAbove>(row, n, threshold, words);
    std::int64_t start = -1;
    for (std::uint64_t& word : words) {
      const std::int64_t first = start < 0 ? 0 : start;
      const std::int64_t from = first < n - 64 ? first : n - 64;
      prefetch(reinterpret_cast<const std::array<T, 64>*>(reinterpret_cast<const std::byte*>(row + from) + kAhead));
      const std::uint64_t bits = Lanes::template compare<T, kAbove>(row + from, threshold);
      const std::int64_t beyond = start - from;
      word = beyond < 0 ? bits << 1 : beyond < 64 ? bits >> beyond : 0;
      start += 64;
    }
  }

  template <class T, bool kAbove>
  static void compare_few(const T* row, std::int64_t n, T threshold, std::span<std::uint64_t> words) {
    T samples[64] = {};
    std::memcpy(samples, row, static_cast<std::size_t>(n) * sizeof(T));
    const std::uint64_t exist = (std::uint64_t{1} << n) - 1;
    const std::uint64_t bits = Lanes::template compare<T, kAbove>(samples, threshold) & exist;
    std::uint64_t next = bits << 1;
    for (std::uint64_t& word : words) {
      word = next;
      next = &word == words.data() ? bits >> 63 : 0;
    }
  }

  static void differ_along(const std::uint64_t* a, const std::uint64_t* b, const std::uint64_t* __restrict mask,
                           std::size_t words, std::uint64_t* __restrict out) {
    for (std::size_t w = 0; w + 1 < words; ++w) out[w] = (a[w] ^ (b[w] >> 1 | b[w + 1] << 63)) & mask[w];
    out[words - 1] = (a[words - 1] ^ b[words - 1] >> 1) & mask[words - 1];
  }

  static void differ(const std::uint64_t* __restrict a, const std::uint64_t* __restrict b, std::size_t words,
                     std::uint64_t* __restrict out) {
    for (std::size_t w = 0; w < words; ++w) out[w] = a[w] ^ b[w];
  }

  static void cells_crossed(const std::array<const std::uint64_t*, 4>& rows, const std::uint64_t* __restrict mask,
                            std::size_t words, std::uint64_t* __restrict out) {
    const std::uint64_t* const a = rows[0];
    const std::uint64_t* const b = rows[1];
    const std::uint64_t* const c = rows[2];
    const std::uint64_t* const d = rows[3];
    std::size_t w = 0;
    for (; w + 1 < words; ++w) {
      const std::uint64_t any = a[w] | b[w] | c[w] | d[w];
      const std::uint64_t any_next = a[w + 1] | b[w + 1] | c[w + 1] | d[w + 1];
      const std::uint64_t all = a[w] & b[w] & c[w] & d[w];
      const std::uint64_t all_next = a[w + 1] & b[w + 1] & c[w + 1] & d[w + 1];
      out[w] = (any | any >> 1 | any_next << 63) & ~(all & (all >> 1 | all_next << 63)) & mask[w];
    }
    const std::uint64_t any = a[w] | b[w] | c[w] | d[w];
    const std::uint64_t all = a[w] & b[w] & c[w] & d[w];
    out[w] = (any | any >> 1) & ~(all & all >> 1) & mask[w];
  }
};

}  // namespace isoweave
