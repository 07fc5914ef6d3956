#include "system/pages.hpp"

#include <sys/mman.h>

#include <cstring>
#include <new>

namespace isoweave::system {
namespace {

void* checked(void* pages) {
  if (pages == MAP_FAILED) throw std::bad_alloc();
  return pages;
}

// Asks for huge pages. Small pages do as well.
void wish_for_huge_pages([[maybe_unused]] void* pages, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  ::madvise(pages, bytes, MADV_HUGEPAGE);
#endif
}

}  // namespace

void* take_pages(std::size_t bytes) {
  void* const pages = checked(::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  wish_for_huge_pages(pages, bytes);
  return pages;
}

void* grow_pages(void* pages, std::size_t bytes, std::size_t more) {
#ifdef MREMAP_MAYMOVE
  void* const grown = checked(::mremap(pages, bytes, more, MREMAP_MAYMOVE));
  wish_for_huge_pages(grown, more);
  return grown;
#else
  void* const grown = take_pages(more);
  std::memcpy(grown, pages, bytes);
  free_pages(pages, bytes);
  return grown;
#endif
}

void free_pages(void* pages, std::size_t bytes) noexcept { ::munmap(pages, bytes); }

}  // namespace isoweave::system
