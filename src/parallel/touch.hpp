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
  constexpr std::uintptr_t kPage = std::uintptr_t{2} << 20;
  const auto begin = reinterpret_cast<std::uintptr_t>(array.data() + first);
  const auto end = reinterpret_cast<std::uintptr_t>(array.data() + array.size());
  const std::uintptr_t first_page = (begin + kPage - 1) / kPage;
  const std::uintptr_t end_page = (end + kPage - 1) / kPage;
  if (end_page <= first_page + 1) return;
  executor.for_each(static_cast<std::int64_t>(end_page - first_page), 1, [&](std::int64_t n) {
    *reinterpret_cast<volatile char*>((first_page + static_cast<std::uintptr_t>(n)) * kPage) = 0;
  });
}

}  // namespace isoweave
