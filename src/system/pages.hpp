// Memory straight from the system, in whole pages.
#pragma once

#include <cstddef>

namespace isoweave::system {

// Counts of bytes for the functions below are multiples of this.
inline constexpr std::size_t kHugePage = std::size_t{2} << 20;

// Zeros, on huge pages where the system has them. Pages cost nothing until they are touched. Throws std::bad_alloc.
void* take_pages(std::size_t bytes);

// Grows pages: returns the same bytes followed by zeros, perhaps at another address. There is no copy where the system
// can move pages. Throws std::bad_alloc, and changes nothing then.
void* grow_pages(void* pages, std::size_t bytes, std::size_t more);

void free_pages(void* pages, std::size_t bytes) noexcept;

}  // namespace isoweave::system
