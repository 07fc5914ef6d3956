#include "vtk_smp.hpp"

#include <vtkSMPTools.h>

#include <stdexcept>
#include <string>

namespace bench {

void use_vtk_threads(const char* backend, int threads) {
  if (!vtkSMPTools::SetBackend(backend)) throw std::runtime_error(std::string("this VTK has no back end ") + backend);
  vtkSMPTools::Initialize(threads);
}

}  // namespace bench
