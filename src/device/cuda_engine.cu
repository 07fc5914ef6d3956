// The engine on a CUDA device.
#include "device/bulk_engine.hpp"
#include "device/cuda_device.cuh"
#include "device/cuda_engine.hpp"

namespace isoweave {

bool has_cuda_back_end() { return true; }

std::unique_ptr<DeviceEngine> make_cuda_engine(const BulkOptions& options) {
  return std::make_unique<BulkEngine<cuda::Device>>(cuda::Device(), options);
}

}  // namespace isoweave
