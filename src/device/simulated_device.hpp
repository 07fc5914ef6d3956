// A device that is the host: everything that a BulkEngine needs of a device, on processors. The tests run the passes on
// it, so that all but launches and copies is checked where there is no GPU.
#pragma once

#include <cstring>
#include <mutex>

#include "parallel/array.hpp"
#include "parallel/parallel.hpp"
#include "simplify/round_passes.hpp"
#include "simplify/scalar_arithmetic.hpp"

namespace isoweave {

class HostDevice {
 public:
  explicit HostDevice(const Executor& executor) : executor_(executor) {}

  // An array in the memory of the device. resize() keeps the old elements, and leaves new ones without a value.
  template <class T>
  using Buffer = Array<T>;

  // The free memory of the device.
  std::uint64_t free_bytes() const { return ~std::uint64_t{0}; }

  // Runs Pass for the numbers from 0 to `count`, all at the same time. Passes run one after the other. They are members
  // that are not const: nvcc 13.0 cannot spell pointers to const ones where it launches them.
  template <auto Pass, class Passes, class... Arguments>
  void for_each(std::int64_t count, Passes passes, Arguments... arguments) {
    executor_.for_each(count, kBlock, [&](std::int64_t n) { (passes.*Pass)(n, arguments...); });
  }

  // Runs a pass that adds to totals.
  template <auto Pass, class Totals, class Passes>
  Totals sum(std::int64_t count, Passes passes) {
    Totals sum;
    std::mutex summing;
    executor_.for_blocks(count, kBlock, [&](std::int64_t begin, std::int64_t end) {
      Totals own;
      for (std::int64_t n = begin; n < end; ++n) (passes.*Pass)(n, own);
      const std::lock_guard guard(summing);
      sum += own;
    });
    return sum;
  }

  // Runs a test: bit b of out[n] tells whether Test holds for 32 * n + b.
  template <auto Test, class Passes, class... Arguments>
  void fill_bits(std::int64_t count, Passes passes, std::uint32_t* out, Arguments... arguments) {
    executor_.for_each(count, kBlock, [&](std::int64_t n) {
      std::uint32_t bits = 0;
      for (std::int64_t b = 0; b < 32; ++b) {
        bits |= std::uint32_t{(passes.*Test)(32 * n + b, arguments...)} << b;
      }
      out[n] = bits;
    });
  }

  // Replaces the first `count` values by the sums of those before them. The sum of all follows the last one.
  void scan(Buffer<std::uint32_t>& values, std::size_t count) {
    std::uint32_t total = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t own = values[n];
      values[n] = total;
      total += own;
    }
    values[count] = total;
  }

  template <class T>
  void clear(Buffer<T>& values) {
    if (values.size() > 0) std::memset(static_cast<void*>(values.data()), 0, values.size() * sizeof(T));
  }

  // Copies between host and device, and within the device. After a read the host has the data; after a write the caller
  // may change the source.
  template <class T>
  void read(const T* from, std::size_t count, T* to) {
    copy(from, count, to);
  }
  template <class T>
  void write(const T* from, std::size_t count, T* to) {
    copy(from, count, to);
  }
  template <class T>
  void copy(const T* from, std::size_t count, T* to) {
    if (count > 0) std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
  }

  // Copies to the device while other work runs there. order_uploads() makes uploads wait for all work asked for so far;
  // await_uploads() makes all later work wait for the uploads.
  void upload(const std::byte* from, std::size_t bytes, std::byte* to) { copy(from, bytes, to); }
  void order_uploads() {}
  void await_uploads() {}

  // Runs rounds until nothing changes any more. Returns the number of rounds.
  std::uint64_t run_rounds(const RoundPasses<ScalarArithmetic>& passes, DecisionCounts& counts) {
    std::uint64_t rounds = 0;
    for (; *passes.changed.size > 0; ++rounds) {
      using Passes = RoundPasses<ScalarArithmetic>;
      *passes.candidates.size = *passes.minima.size = 0;
      for_each<&Passes::list_candidates>(*passes.changed.size, passes);
      for_each<&Passes::pick_minimum>(*passes.candidates.size, passes);
      *passes.changed.size = 0;
      counts += sum<&Passes::decide, DecisionCounts>(*passes.minima.size, passes);
      for_each<&Passes::renew>(*passes.changed.size, passes);
      for_each<&Passes::forget_candidate>(*passes.candidates.size, passes);
    }
    return rounds;
  }

 private:
  static constexpr std::int64_t kBlock = 1024;

  const Executor& executor_;
};

}  // namespace isoweave
