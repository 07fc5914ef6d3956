// Memory of a CUDA device, and its errors as exceptions.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "isoweave/error.hpp"

namespace isoweave::cuda {

inline void check(cudaError_t error, const char* what) {
  if (error == cudaSuccess) return;
  cudaGetLastError();  // the next call starts without it
  throw DeviceError(std::string("--device cuda: ") + what + ": " + cudaGetErrorString(error));
}

inline cudaStream_t stream() { return cudaStreamPerThread; }

// Replaces values by the sums of those before them (scan.cu).
void exclusive_scan(std::uint32_t* values, std::size_t count, std::byte*& scratch, std::size_t& scratch_bytes);

// Memory of the device that grows as isoweave::Array does.
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer() = default;
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer() {
    if (data_ != nullptr) cudaFreeAsync(data_, stream());
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }

  void resize(std::size_t size) {
    if (size > capacity_) reserve(std::max(size, capacity_ + capacity_ / 4));
    size_ = size;
  }

 private:
  void reserve(std::size_t capacity) {
    void* memory = nullptr;
    check(cudaMallocAsync(&memory, capacity * sizeof(T), stream()), "no memory left on the device");
    if (data_ != nullptr) {
      check(cudaMemcpyAsync(memory, data_, size_ * sizeof(T), cudaMemcpyDeviceToDevice, stream()), "copy");
      check(cudaFreeAsync(data_, stream()), "free");
    }
    data_ = static_cast<T*>(memory);
    capacity_ = capacity;
  }

  void swap(Buffer& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace isoweave::cuda
