// Counts of 64 bits as sizes of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <type_traits>

namespace isoweave {

// Throws std::bad_array_new_length where the machine's sizes have fewer bits than the count needs.
template <class Count>
constexpr std::size_t to_size(Count count) {
  static_assert(std::is_integral_v<Count>);
  if constexpr (sizeof(std::size_t) < sizeof(Count)) {
    if (static_cast<std::make_unsigned_t<Count>>(count) > std::numeric_limits<std::size_t>::max()) {
      throw std::bad_array_new_length();
    }
  }
  return static_cast<std::size_t>(count);
}

// The size of so many elements.
template <class Count>
constexpr std::size_t to_size(Count count, std::size_t each) {
  const std::size_t elements = to_size(count);
  if (each > 0 && elements > std::numeric_limits<std::size_t>::max() / each) throw std::bad_array_new_length();
  return elements * each;
}

}  // namespace isoweave
