// First touches of new memory. Huge pages are cleared when they are touched first; a pass over consecutive elements has
// all threads wait for one that clears the page they share.
#pragma once

#include <cstddef>
#include <cstdint>

#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

// Touches the pages that elements from `first` on begin, each by one thread. The elements are to be filled afterwards.
template <class T>
void touch(Array<T>& array, std::size_t first, const Executor& executor) {
  constexpr std::size_t kPage = std::size_t{2} << 20;
  auto* const bytes = reinterpret_cast<volatile char*>(array.data());
  const auto place = reinterpret_cast<std::uintptr_t>(array.data());
  const std::size_t end = array.size() * sizeof(T);
  const std::size_t begin = first * sizeof(T);
  const std::size_t first_page = begin + (kPage - (place + begin) % kPage) % kPage;
  if (first_page + kPage >= end) return;
  const std::size_t pages = (end - first_page + kPage - 1) / kPage;
  executor.for_each(static_cast<std::int64_t>(pages), 1,
                    [&](std::int64_t n) { bytes[first_page + static_cast<std::size_t>(n) * kPage] = 0; });
}

}  // namespace isoweave
