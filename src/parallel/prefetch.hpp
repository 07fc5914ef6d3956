// Fetching memory before it is needed: a walk over triangles would wait for one line of memory after the other.
#pragma once

#include <cstddef>

#include "parallel/annotations.hpp"

namespace isoweave {

inline constexpr std::size_t kMemoryLine = 64;  // bytes

// Fetches the lines of memory that an object lies on. There need not be such an object. Does nothing on a device.
template <class T>
ISOWEAVE_HD inline void prefetch([[maybe_unused]] const T* object) {
#ifndef __CUDA_ARCH__
  const auto* const bytes = reinterpret_cast<const std::byte*>(object);
  for (std::size_t line = 0; line < sizeof(T); line += kMemoryLine) __builtin_prefetch(bytes + line);
#endif
}

}  // namespace isoweave
