// A CUDA device, as a BulkEngine needs one (see simulated_device.hpp).
//
// All work runs on one stream, except uploads of slices, which have a stream of their own. The host waits where it
// reads a count or a result, and once after several rounds.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "device/cuda_memory.cuh"
#include "simplify/round_passes.hpp"
#include "simplify/scalar_arithmetic.hpp"

namespace isoweave::cuda {

inline constexpr unsigned kThreads = 128;  // of a block

__device__ inline std::int64_t first_item() { return std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x; }
__device__ inline std::int64_t item_step() { return std::int64_t{gridDim.x} * blockDim.x; }

template <auto Pass, class Passes, class... Arguments>
__global__ void for_each_kernel(std::int64_t count, Passes passes, Arguments... arguments) {
  for (std::int64_t n = first_item(); n < count; n += item_step()) (passes.*Pass)(n, arguments...);
}

// Adds the totals of all threads of a warp, field by field, and then those of all warps: integers, so the order means
// nothing.
__device__ inline void add_fields(const void* own, void* sum, std::size_t count) {
  const auto* fields = static_cast<const std::uint64_t*>(own);
  auto* sums = static_cast<std::uint64_t*>(sum);
  for (std::size_t f = 0; f < count; ++f) {
    std::uint64_t field = fields[f];
    for (unsigned other = 16; other > 0; other /= 2) field += __shfl_down_sync(0xffffffffu, field, other);
    if (threadIdx.x % 32 == 0 && field != 0) fetch_add(sums[f], field);
  }
}

template <class Totals>
__device__ void add_totals(const Totals& own, Totals* sum) {
  static_assert(sizeof(Totals) % sizeof(std::uint64_t) == 0);
  add_fields(&own, sum, sizeof(Totals) / sizeof(std::uint64_t));
}

// Adds the totals of decisions, of which the last field is a maximum.
__device__ inline void add_totals(const DecisionCounts& own, DecisionCounts* sum) {
  static_assert(offsetof(DecisionCounts, dearest) == sizeof(DecisionCounts) - sizeof(std::uint64_t));
  add_fields(&own, sum, offsetof(DecisionCounts, dearest) / sizeof(std::uint64_t));
  const unsigned dearest = __reduce_max_sync(0xffffffffu, static_cast<unsigned>(own.dearest));  // of type CostBits
  if (threadIdx.x % 32 == 0 && dearest != 0) {
    atomicMax(reinterpret_cast<unsigned long long*>(&sum->dearest), static_cast<unsigned long long>(dearest));
  }
}

template <auto Pass, class Totals, class Passes>
__global__ void sum_kernel(std::int64_t count, Passes passes, Totals* sum) {
  Totals own;
  for (std::int64_t n = first_item(); n < count; n += item_step()) (passes.*Pass)(n, own);
  add_totals(own, sum);
}

// Tests samples that lie side by side: a warp makes 32 bits at a time.
template <auto Test, class Passes, class... Arguments>
__global__ void fill_bits_kernel(std::int64_t count, Passes passes, std::uint32_t* out, Arguments... arguments) {
  for (std::int64_t n = first_item(); n < 32 * count; n += item_step()) {
    const std::uint32_t bits = __ballot_sync(0xffffffffu, (passes.*Test)(n, arguments...));
    if (threadIdx.x % 32 == 0) out[n / 32] = bits;
  }
}

// The counts of the rounds of a slab.
struct RoundTotals {
  DecisionCounts decisions;
  std::uint64_t rounds = 0;
  std::uint64_t candidates = 0;  // of the round that runs
};

// The four passes of a round, one launch each. The size of a list is set to zero in a pass that neither reads that size
// nor adds to the list. A round without changes does nothing, so rounds can be launched before the host knows how many
// there are.
using Rounds = RoundPasses<ScalarArithmetic>;

__device__ inline std::int64_t size_of(const IndexList& list) { return std::int64_t{load_relaxed(*list.size)}; }

static __global__ void __launch_bounds__(kThreads) candidates_kernel(Rounds passes, RoundTotals* totals) {
  const std::int64_t changed = size_of(passes.changed);
  if (first_item() == 0) {
    *passes.minima.size = 0;
    if (changed > 0) ++totals->rounds;
  }
  for (std::int64_t n = first_item(); n < changed; n += item_step()) passes.list_candidates(n);
}

static __global__ void __launch_bounds__(kThreads) minima_kernel(Rounds passes) {
  const std::int64_t candidates = size_of(passes.candidates);
  if (first_item() == 0) *passes.changed.size = 0;
  for (std::int64_t n = first_item(); n < candidates; n += item_step()) passes.pick_minimum(n);
}

static __global__ void __launch_bounds__(kThreads) decisions_kernel(Rounds passes, RoundTotals* totals) {
  const std::int64_t minima = size_of(passes.minima);
  if (first_item() == 0) {
    totals->candidates = *passes.candidates.size;
    *passes.candidates.size = 0;
  }
  DecisionCounts own;
  for (std::int64_t n = first_item(); n < minima; n += item_step()) passes.decide(n, own);
  add_totals(own, &totals->decisions);
}

static __global__ void __launch_bounds__(kThreads) turns_kernel(Rounds passes, const RoundTotals* totals) {
  const std::int64_t changed = size_of(passes.changed);
  const auto candidates = static_cast<std::int64_t>(totals->candidates);
  for (std::int64_t n = first_item(); n < changed; n += item_step()) passes.renew(n);
  for (std::int64_t n = first_item(); n < candidates; n += item_step()) passes.forget_candidate(n);
}

// Host memory that the device copies from and to without the processor.
class Pinned {
 public:
  explicit Pinned(std::size_t bytes) : bytes_(bytes) {
    check(cudaMallocHost(&memory_, bytes), "no page-locked memory");
    check(cudaEventCreateWithFlags(&copied_, cudaEventDisableTiming), "event");
  }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;
  ~Pinned() {
    cudaEventSynchronize(copied_);
    cudaEventDestroy(copied_);
    cudaFreeHost(memory_);
  }

  std::size_t bytes() const { return bytes_; }
  void* memory() { return memory_; }

  void wait() { check(cudaEventSynchronize(copied_), "copy"); }
  void record(cudaStream_t on) { check(cudaEventRecord(copied_, on), "event"); }

 private:
  void* memory_ = nullptr;
  std::size_t bytes_;
  cudaEvent_t copied_ = nullptr;
};

class Device {
 public:
  template <class T>
  using Buffer = cuda::Buffer<T>;

  Device() {
    int devices = 0;
    const cudaError_t found = cudaGetDeviceCount(&devices);
    if (found != cudaSuccess || devices == 0) {
      cudaGetLastError();
      throw DeviceError(std::string("--device cuda: expected a CUDA device, found none: ") + cudaGetErrorString(found));
    }
    int device = 0;
    check(cudaGetDevice(&device), "device");
    check(cudaDeviceGetAttribute(&processors_, cudaDevAttrMultiProcessorCount, device), "device");
    keep_freed_memory(device);
    check(cudaStreamCreateWithFlags(&uploads_, cudaStreamNonBlocking), "stream");
    check(cudaEventCreateWithFlags(&uploaded_, cudaEventDisableTiming), "event");
    for (auto& staging : staging_) staging = std::make_unique<Pinned>(kStaging);
  }
  Device(Device&& other) noexcept
      : processors_(other.processors_),
        pool_(other.pool_),
        uploads_(std::exchange(other.uploads_, nullptr)),
        uploaded_(std::exchange(other.uploaded_, nullptr)),
        staging_(std::move(other.staging_)),
        next_staging_(other.next_staging_),
        scratch_(std::exchange(other.scratch_, nullptr)),
        scratch_bytes_(std::exchange(other.scratch_bytes_, 0)) {}
  ~Device() {
    if (uploads_ == nullptr) return;
    cudaStreamSynchronize(uploads_);
    cudaStreamSynchronize(stream());
    cudaFreeAsync(scratch_, stream());
    cudaEventDestroy(uploaded_);
    cudaStreamDestroy(uploads_);
  }

  // The free memory of the device. Memory that the pool holds and nobody uses counts as free.
  std::uint64_t free_bytes() const {
    std::size_t free = 0;
    std::size_t total = 0;
    check(cudaMemGetInfo(&free, &total), "memory");
    std::uint64_t reserved = 0;
    std::uint64_t used = 0;
    check(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrReservedMemCurrent, &reserved), "memory pool");
    check(cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrUsedMemCurrent, &used), "memory pool");
    return free + (reserved - used);
  }

  template <auto Pass, class Passes, class... Arguments>
  void for_each(std::int64_t count, const Passes& passes, Arguments... arguments) {
    if (count <= 0) return;
    for_each_kernel<Pass><<<blocks(count), kThreads, 0, stream()>>>(count, passes, arguments...);
    check(cudaGetLastError(), "launch");
  }

  template <auto Pass, class Totals, class Passes>
  Totals sum(std::int64_t count, const Passes& passes) {
    Totals sum;
    if (count <= 0) return sum;
    Buffer<Totals> totals;
    totals.resize(1);
    write(&sum, 1, totals.data());
    sum_kernel<Pass><<<blocks(count), kThreads, 0, stream()>>>(count, passes, totals.data());
    check(cudaGetLastError(), "launch");
    read(totals.data(), 1, &sum);
    return sum;
  }

  template <auto Test, class Passes, class... Arguments>
  void fill_bits(std::int64_t count, const Passes& passes, std::uint32_t* out, Arguments... arguments) {
    if (count <= 0) return;
    fill_bits_kernel<Test><<<blocks(32 * count), kThreads, 0, stream()>>>(count, passes, out, arguments...);
    check(cudaGetLastError(), "launch");
  }

  void scan(Buffer<std::uint32_t>& values, std::size_t count) {
    check(cudaMemsetAsync(values.data() + count, 0, sizeof(std::uint32_t), stream()), "fill");
    exclusive_scan(values.data(), count + 1, scratch_, scratch_bytes_);
  }

  template <class T>
  void clear(Buffer<T>& values) {
    if (values.size() == 0) return;
    check(cudaMemsetAsync(values.data(), 0, values.size() * sizeof(T), stream()), "fill");
  }

  template <class T>
  void read(const T* from, std::size_t count, T* to) {
    auto* out = reinterpret_cast<std::byte*>(to);
    const auto* in = reinterpret_cast<const std::byte*>(from);
    for (std::size_t left = count * sizeof(T); left > 0;) {
      Pinned& staging = free_staging();
      const std::size_t bytes = std::min(left, staging.bytes());
      check(cudaMemcpyAsync(staging.memory(), in, bytes, cudaMemcpyDeviceToHost, stream()), "copy");
      staging.record(stream());
      staging.wait();
      std::memcpy(out, staging.memory(), bytes);
      in += bytes;
      out += bytes;
      left -= bytes;
    }
  }

  template <class T>
  void write(const T* from, std::size_t count, T* to) {
    write_on(stream(), reinterpret_cast<const std::byte*>(from), count * sizeof(T), reinterpret_cast<std::byte*>(to));
  }

  template <class T>
  void copy(const T* from, std::size_t count, T* to) {
    if (count == 0) return;
    check(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToDevice, stream()), "copy");
  }

  void upload(const std::byte* from, std::size_t bytes, std::byte* to) { write_on(uploads_, from, bytes, to); }

  // Makes later uploads wait for all work on the ring so far, as the ring has moved.
  void order_uploads() {
    check(cudaEventRecord(uploaded_, stream()), "event");
    check(cudaStreamWaitEvent(uploads_, uploaded_, 0), "event");
  }

  void await_uploads() {
    check(cudaEventRecord(uploaded_, uploads_), "event");
    check(cudaStreamWaitEvent(stream(), uploaded_, 0), "event");
  }

  std::uint64_t run_rounds(const Rounds& passes, DecisionCounts& counts) {
    Buffer<RoundTotals> totals;
    totals.resize(1);
    RoundTotals sum;
    write(&sum, 1, totals.data());
    const unsigned grids[4] = {filled_by(candidates_kernel), filled_by(minima_kernel), filled_by(decisions_kernel),
                               filled_by(turns_kernel)};
    std::uint32_t changed = 0;
    do {
      for (int n = 0; n < kRoundsAtOnce; ++n) {
        candidates_kernel<<<grids[0], kThreads, 0, stream()>>>(passes, totals.data());
        minima_kernel<<<grids[1], kThreads, 0, stream()>>>(passes);
        decisions_kernel<<<grids[2], kThreads, 0, stream()>>>(passes, totals.data());
        turns_kernel<<<grids[3], kThreads, 0, stream()>>>(passes, totals.data());
      }
      check(cudaGetLastError(), "launch");
      read(passes.changed.size, 1, &changed);
    } while (changed > 0);
    read(totals.data(), 1, &sum);
    counts += sum.decisions;
    return sum.rounds;
  }

 private:
  static constexpr std::size_t kStaging = std::size_t{8} << 20;

  // Rounds between two looks of the host at what is left. A launch that finds nothing to do takes some microseconds.
  static constexpr int kRoundsAtOnce = 16;

  // The blocks of a kernel that the device runs at the same time.
  template <class Kernel>
  unsigned filled_by(Kernel* kernel) const {
    int blocks_each = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks_each, kernel, kThreads, 0), "launch");
    return static_cast<unsigned>(std::max(blocks_each, 1) * processors_);
  }

  // Keeps freed memory with the process, as slabs want it again at once.
  void keep_freed_memory(int device) {
    std::uint64_t all = ~std::uint64_t{0};
    check(cudaDeviceGetDefaultMemPool(&pool_, device), "memory pool");
    check(cudaMemPoolSetAttribute(pool_, cudaMemPoolAttrReleaseThreshold, &all), "memory pool");
  }

  // The blocks of a launch. Each thread takes several items where there are many.
  unsigned blocks(std::int64_t count) const {
    const std::int64_t wanted = (count + kThreads - 1) / kThreads;
    return static_cast<unsigned>(std::min<std::int64_t>(wanted, std::int64_t{64} * processors_));
  }

  Pinned& free_staging() {
    Pinned& staging = *staging_[next_staging_];
    next_staging_ = (next_staging_ + 1) % staging_.size();
    staging.wait();
    return staging;
  }

  void write_on(cudaStream_t on, const std::byte* from, std::size_t bytes, std::byte* to) {
    while (bytes > 0) {
      Pinned& staging = free_staging();
      const std::size_t part = std::min(bytes, staging.bytes());
      std::memcpy(staging.memory(), from, part);
      check(cudaMemcpyAsync(to, staging.memory(), part, cudaMemcpyHostToDevice, on), "copy");
      staging.record(on);
      from += part;
      to += part;
      bytes -= part;
    }
  }

  int processors_ = 1;
  cudaMemPool_t pool_ = nullptr;
  cudaStream_t uploads_ = nullptr;
  cudaEvent_t uploaded_ = nullptr;
  std::array<std::unique_ptr<Pinned>, 4> staging_;
  std::size_t next_staging_ = 0;
  std::byte* scratch_ = nullptr;  // of the scan
  std::size_t scratch_bytes_ = 0;
};

}  // namespace isoweave::cuda
