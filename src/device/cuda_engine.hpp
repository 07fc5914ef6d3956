// The CUDA back end, where the build has it.
#pragma once

#include <memory>

#include "device/device_engine.hpp"

namespace isoweave {

bool has_cuda_back_end();

// Throws DeviceError where there is no device, or where the build has no back end for one, and OverMemory where
// one layer of the volume is too many for a slab.
std::unique_ptr<DeviceEngine> make_cuda_engine(const BulkOptions& options);

}  // namespace isoweave
