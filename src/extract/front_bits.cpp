#include "extract/front_bits.hpp"

#include <algorithm>

#include "parallel/size.hpp"

namespace isoweave {
namespace {

// Whether all bits of a row outside [first, end) are 0.
bool lies_between(std::span<const std::uint64_t> row, std::int64_t first, std::int64_t end) {
  for (std::size_t w = 0; w < row.size(); ++w) {
    for (int bit = 0; bit < 64; ++bit) {
      const std::int64_t at = 64 * static_cast<std::int64_t>(w) + bit;
      if ((row[w] >> bit & 1) != 0 && (at < first || at >= end)) return false;
    }
  }
  return true;
}

}  // namespace

void FrontBits::write(StateWriter& state) const {
  state.value(next_layer);
  state.list(inside);
}

FrontBits FrontBits::read(StateReader& state, const std::array<std::int64_t, 3>& dims, std::int64_t end_layer,
                          std::size_t slices) {
  FrontBits front;
  state.value(front.next_layer);
  state.require(front.next_layer >= -1 && front.next_layer <= end_layer, "a layer of the volume");
  state.list(front.inside);
  const std::size_t words = (to_size(dims[0]) + 2 + 63) / 64;
  const std::size_t rows = to_size(dims[1]) + 2;
  state.require(front.inside.size() == to_size(to_size(words, rows), slices), "the bits of a slice of the volume");
  for (std::size_t row = 0; row < slices * rows; ++row) {
    const bool is_pad = row % rows == 0 || row % rows == rows - 1;
    const std::span<const std::uint64_t> bits(front.inside.data() + row * words, words);
    state.require(lies_between(bits, 1, is_pad ? 1 : dims[0] + 1), "no inside points around the volume");
  }
  return front;
}

}  // namespace isoweave
