// The first half of whole jobs with VTK.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "input.hpp"

namespace bench {

// Reads the whole file and extracts its surface. The volume is gone when it returns.
vtkSmartPointer<vtkPolyData> flying_edges(const VolumeFile& file, int threads);

}  // namespace bench
