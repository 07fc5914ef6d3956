// First touches of new memory. Huge pages are cleared when they are touched first; a pass over consecutive elements has
// all threads wait for one that clears the page they share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "parallel/parallel.hpp"

namespace isoweave {

// Touches the pages that begin among elements that are to be filled, each by one thread.
template <class T>
void touch(std::span<T> elements, const Executor& executor) {
  constexpr std::size_t kPage = std::size_t{2} << 20;
  auto* const bytes = reinterpret_cast<volatile char*>(elements.data());
  const auto place = reinterpret_cast<std::uintptr_t>(elements.data());
  const std::size_t first_page = (kPage - place % kPage) % kPage;
  if (first_page + kPage >= elements.size_bytes()) return;
  const std::size_t pages = (elements.size_bytes() - first_page + kPage - 1) / kPage;
  executor.for_each(static_cast<std::int64_t>(pages), 1,
                    [&](std::int64_t n) { bytes[first_page + static_cast<std::size_t>(n) * kPage] = 0; });
}

}  // namespace isoweave
