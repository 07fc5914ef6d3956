// A CUDA device, as a BulkEngine needs one (see simulated_device.hpp).
//
// All work runs on one stream, except uploads of slices, which have a stream of their own. The host waits where it
// reads a count or a result, never within the rounds of a slab.
#pragma once

#include <cooperative_groups.h>
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

// Adds the totals of all threads, field by field: integers, so the order means nothing.
__device__ inline void add_fields(const void* own, void* sum, std::size_t count) {
  const auto* fields = static_cast<const std::uint64_t*>(own);
  auto* sums = static_cast<std::uint64_t*>(sum);
  for (std::size_t f = 0; f < count; ++f) {
    if (fields[f] != 0) fetch_add(sums[f], fields[f]);
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
  atomicMax(reinterpret_cast<unsigned long long*>(&sum->dearest), static_cast<unsigned long long>(own.dearest));
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

// The counts of a loop of rounds.
struct RoundTotals {
  DecisionCounts decisions;
  std::uint64_t rounds = 0;
};

__device__ inline void add_totals(const RoundTotals& own, RoundTotals* sum) {
  add_totals(own.decisions, &sum->decisions);
  fetch_add(sum->rounds, own.rounds);
}

// All rounds of a slab in one launch: a barrier of the whole grid stands between two passes. The size of a list is set
// to zero in a pass that neither reads that size nor adds to the list.
static __global__ void __launch_bounds__(kThreads)
    rounds_kernel(RoundPasses<ScalarArithmetic> passes, RoundTotals* totals) {
  const cooperative_groups::grid_group grid = cooperative_groups::this_grid();
  const bool first = first_item() == 0;
  const auto size = [](const IndexList& list) { return std::int64_t{load_relaxed(*list.size)}; };
  RoundTotals own;
  while (size(passes.changed) > 0) {
    const std::int64_t changed = size(passes.changed);
    if (first) *passes.minima.size = 0;
    for (std::int64_t n = first_item(); n < changed; n += item_step()) passes.list_candidates(n);
    grid.sync();
    const std::int64_t candidates = size(passes.candidates);
    if (first) *passes.changed.size = 0;
    for (std::int64_t n = first_item(); n < candidates; n += item_step()) passes.pick_minimum(n);
    grid.sync();
    const std::int64_t minima = size(passes.minima);
    if (first) *passes.candidates.size = 0;
    for (std::int64_t n = first_item(); n < minima; n += item_step()) passes.decide(n, own.decisions);
    grid.sync();
    const std::int64_t touched = size(passes.changed);
    for (std::int64_t n = first_item(); n < touched; n += item_step()) passes.renew(n);
    for (std::int64_t n = first_item(); n < candidates; n += item_step()) passes.forget_candidate(n);
    grid.sync();
    if (first) ++own.rounds;
  }
  add_totals(own, totals);
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
    int cooperative = 0;
    check(cudaDeviceGetAttribute(&cooperative, cudaDevAttrCooperativeLaunch, device), "device");
    if (cooperative == 0) throw DeviceError("--device cuda: expected a device with cooperative launches, found none");
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

  std::uint64_t run_rounds(RoundPasses<ScalarArithmetic> passes, DecisionCounts& counts) {
    Buffer<RoundTotals> totals;
    totals.resize(1);
    RoundTotals sum;
    write(&sum, 1, totals.data());
    int blocks_each = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks_each, rounds_kernel, kThreads, 0), "launch");
    RoundTotals* out = totals.data();
    void* arguments[] = {&passes, &out};
    const dim3 grid(static_cast<unsigned>(std::max(blocks_each, 1) * processors_));
    check(cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(rounds_kernel), grid, dim3(kThreads), arguments, 0,
                                      stream()),
          "launch");
    read(totals.data(), 1, &sum);
    counts += sum.decisions;
    return sum.rounds;
  }

 private:
  static constexpr std::size_t kStaging = std::size_t{8} << 20;

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
