// Relaxed atomic access to integers that passes over lists share, on the host and on a device. Between two passes
// everything is visible.
#pragma once

#include <atomic>
#include <cstdint>

#include "parallel/annotations.hpp"

namespace isoweave {

ISOWEAVE_HD inline std::uint32_t load_relaxed(const std::uint32_t& from) {
#ifdef __CUDA_ARCH__
  return *const_cast<const volatile std::uint32_t*>(&from);
#else
  return std::atomic_ref(const_cast<std::uint32_t&>(from)).load(std::memory_order_relaxed);
#endif
}

ISOWEAVE_HD inline void store_relaxed(std::uint32_t& to, std::uint32_t value) {
#ifdef __CUDA_ARCH__
  *const_cast<volatile std::uint32_t*>(&to) = value;
#else
  std::atomic_ref(to).store(value, std::memory_order_relaxed);
#endif
}

// Stores a value so that all threads see it before anything that this thread loads afterwards in that order.
ISOWEAVE_HD inline void publish(std::uint64_t& to, std::uint64_t value) {
#ifdef __CUDA_ARCH__
  to = value;  // passes on a device end in a barrier
#else
  std::atomic_ref(to).store(value, std::memory_order_seq_cst);
#endif
}

// The following functions return the value before the change.

ISOWEAVE_HD inline std::uint32_t fetch_add(std::uint32_t& at, std::uint32_t value) {
#ifdef __CUDA_ARCH__
  return atomicAdd(&at, value);
#else
  return std::atomic_ref(at).fetch_add(value, std::memory_order_relaxed);
#endif
}

ISOWEAVE_HD inline std::uint64_t fetch_add(std::uint64_t& at, std::uint64_t value) {
#ifdef __CUDA_ARCH__
  static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
  return atomicAdd(reinterpret_cast<unsigned long long*>(&at), value);
#else
  return std::atomic_ref(at).fetch_add(value, std::memory_order_relaxed);
#endif
}

ISOWEAVE_HD inline std::uint32_t fetch_or(std::uint32_t& at, std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return atomicOr(&at, bits);
#else
  return std::atomic_ref(at).fetch_or(bits, std::memory_order_relaxed);
#endif
}

ISOWEAVE_HD inline std::uint32_t fetch_and(std::uint32_t& at, std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return atomicAnd(&at, bits);
#else
  return std::atomic_ref(at).fetch_and(bits, std::memory_order_relaxed);
#endif
}

ISOWEAVE_HD inline void make_least(std::uint32_t& at, std::uint32_t value) {
#ifdef __CUDA_ARCH__
  atomicMin(&at, value);
#else
  const std::atomic_ref<std::uint32_t> least(at);
  std::uint32_t found = least.load(std::memory_order_relaxed);
  while (value < found && !least.compare_exchange_weak(found, value, std::memory_order_relaxed)) {
  }
#endif
}

}  // namespace isoweave
