// In place of cuda_engine.cu where there is no CUDA compiler.
#include "device/cuda_engine.hpp"
#include "isoweave/error.hpp"

namespace isoweave {

bool has_cuda_back_end() { return false; }

std::unique_ptr<DeviceEngine> make_cuda_engine(const BulkOptions&) {
  throw DeviceError("--device cuda: this build has no CUDA back end");
}

}  // namespace isoweave
