// A growing array for passes that fill the elements they ask for. resize() leaves new elements without a value, so that
// the threads that fill them touch their pages first. Large arrays ask for huge pages, as walks jump about in them.
// Arrays grow in place, as two copies of the largest would be the peak of a run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "parallel/check.hpp"
#include "system/pages.hpp"

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
  T& operator[](std::size_t n) {
    ISOWEAVE_CHECK(n < size_);
    return data_.get()[n];
  }
  const T& operator[](std::size_t n) const {
    ISOWEAVE_CHECK(n < size_);
    return data_.get()[n];
  }

  // Grows by a quarter where std::vector would double: the zone is what bounds the memory of a run.
  void resize(std::size_t size) {
    if (size > capacity_) reserve(std::max(size, capacity_ + capacity_ / 4));
    size_ = size;
  }

  // Takes memory for so many elements, at least as many as there are.
  void reserve(std::size_t capacity) {
    constexpr std::size_t kPage = system::kHugePage;
    if (capacity > (~std::size_t{0} - kPage) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = capacity * sizeof(T);
    bytes < kPage ? take_from_heap((bytes + 63) / 64 * 64) : take_pages((bytes + kPage - 1) / kPage * kPage);
  }

 private:
  struct Free {
    std::size_t paged = 0;  // bytes; 0: from the heap
    void operator()(T* memory) const { paged > 0 ? system::free_pages(memory, paged) : std::free(memory); }
  };

  void take_from_heap(std::size_t bytes) {
    T* const memory = static_cast<T*>(std::aligned_alloc(64, bytes));
    if (memory == nullptr) throw std::bad_alloc();
    move_to(memory, bytes, 0);
  }

  void take_pages(std::size_t bytes) {
    const std::size_t paged = data_.get_deleter().paged;
    void* const pages = paged > 0 ? system::grow_pages(data_.get(), paged, bytes) : system::take_pages(bytes);
    if (paged > 0) static_cast<void>(data_.release());  // its pages have moved
    move_to(static_cast<T*>(pages), bytes, bytes);
  }

  // Takes the elements along unless the memory has them already.
  void move_to(T* memory, std::size_t bytes, std::size_t paged) {
    if (data_ != nullptr) std::memcpy(memory, data_.get(), size_ * sizeof(T));
    data_ = std::unique_ptr<T, Free>(memory, Free{paged});
    capacity_ = bytes / sizeof(T);
  }

  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace isoweave
