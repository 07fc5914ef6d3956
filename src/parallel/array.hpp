// A growing array for passes that fill what they have asked for: resize() leaves new elements as they are, so that the
// threads that fill them touch their pages first. Large ones ask for huge pages: walks jump about in them.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

namespace isoweave {

template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  bool empty() const { return size_ == 0; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t n) { return data_.get()[n]; }
  const T& operator[](std::size_t n) const { return data_.get()[n]; }

  // Grows by a quarter where std::vector would double: the zone is what bounds the memory of a run.
  void resize(std::size_t size) {
    if (size > capacity_) reserve(std::max(size, capacity_ + capacity_ / 4));
    size_ = size;
  }

 private:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;

  struct Free {
    void operator()(T* memory) const { std::free(memory); }
  };

  void reserve(std::size_t capacity) {
    const std::size_t wanted = capacity * sizeof(T);
    const std::size_t alignment = wanted >= 2 * kHugePage ? kHugePage : 64;
    const std::size_t bytes = (wanted + alignment - 1) / alignment * alignment;
    std::unique_ptr<T, Free> memory(static_cast<T*>(std::aligned_alloc(alignment, bytes)));
    if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (alignment == kHugePage) madvise(memory.get(), bytes, MADV_HUGEPAGE);  // a wish: small pages do as well
#endif
    if (size_ > 0) std::memcpy(memory.get(), data_.get(), size_ * sizeof(T));
    data_ = std::move(memory);
    capacity_ = bytes / sizeof(T);
  }

  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace isoweave
