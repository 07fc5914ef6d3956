// LZF, the compression of h5py.
#pragma once

#include <cstddef>
#include <span>

namespace isoweave {

// Three bytes stand for at most 264.
inline constexpr std::size_t kLzfRatio = 88;

// Decodes `stored` into all of `out`. False for data that are damaged or decode to another size.
bool decode_lzf(std::span<const std::byte> stored, std::span<std::byte> out);

}  // namespace isoweave
