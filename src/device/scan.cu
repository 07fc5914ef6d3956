// The one place that compiles CUB.
#include <cub/device/device_scan.cuh>

#include "device/cuda_memory.cuh"

namespace isoweave::cuda {

void exclusive_scan(std::uint32_t* values, std::size_t count, std::byte*& scratch, std::size_t& scratch_bytes) {
  std::size_t needed = 0;
  const auto items = static_cast<std::int64_t>(count);
  check(cub::DeviceScan::ExclusiveSum(nullptr, needed, values, values, items, stream()), "scan");
  if (needed > scratch_bytes) {
    if (scratch != nullptr) check(cudaFreeAsync(scratch, stream()), "free");
    void* memory = nullptr;
    check(cudaMallocAsync(&memory, needed, stream()), "no memory left on the device");
    scratch = static_cast<std::byte*>(memory);
    scratch_bytes = needed;
  }
  check(cub::DeviceScan::ExclusiveSum(scratch, needed, values, values, items, stream()), "scan");
}

}  // namespace isoweave::cuda
