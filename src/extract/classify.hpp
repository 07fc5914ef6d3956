// Samples to inside bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "extract/cube_rules.hpp"
#include "extract/row_kernels.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

// Sets bit i + 1 of `words` for every inside sample i of a row, clears all others. Bits 0 and n + 1 are the pad.
// `words` holds at least (n + 2 + 63) / 64 words.
void classify_row(const std::byte* row, SampleType type, std::int64_t n, const IsoRule& rule,
                  std::span<std::uint64_t> words, const RowKernels& kernels = row_kernels());

}  // namespace isoweave
