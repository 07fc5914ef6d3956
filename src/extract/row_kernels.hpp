// Passes over the rows of a slice, for the instruction set of this processor. Every set gives the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>

namespace isoweave {

// Compares the n samples of a row with a threshold. Sets bit i + 1 of `words` for every sample i that is not below it
// (or not above it), and clears all others. NaN is neither. `words` holds at least (n + 2 + 63) / 64 words.
template <class T>
struct Comparison {
  using Function = void (*)(const T* row, std::int64_t n, T threshold, std::span<std::uint64_t> words);
  Function at_least;
  Function at_most;
};

struct RowKernels {
  std::tuple<Comparison<std::uint8_t>, Comparison<std::int8_t>, Comparison<std::uint16_t>, Comparison<std::int16_t>,
             Comparison<std::uint32_t>, Comparison<std::int32_t>, Comparison<std::uint64_t>, Comparison<std::int64_t>,
             Comparison<float>, Comparison<double>>
      compare;

  // Finds the bits of row `a` that differ from the next bit of row `b`, which may be the same row, where `mask` has
  // bits. All rows have as many words.
  void (*differ_along)(const std::uint64_t* a, const std::uint64_t* b, const std::uint64_t* mask, std::size_t words,
                       std::uint64_t* out);

  // Finds the bits of two rows that differ.
  void (*differ)(const std::uint64_t* a, const std::uint64_t* b, std::size_t words, std::uint64_t* out);

  // Finds the bits where four rows, each at that bit and at the next one, are not all alike, where `mask` has bits.
  void (*cells_crossed)(const std::array<const std::uint64_t*, 4>& rows, const std::uint64_t* mask, std::size_t words,
                        std::uint64_t* out);
};

// The best kernels for this processor.
const RowKernels& row_kernels();

// All kernels that this processor can run, the best last.
std::span<const RowKernels* const> all_row_kernels();

}  // namespace isoweave
