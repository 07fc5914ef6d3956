// Volumes and meshes as VTK holds them.
#pragma once

#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "input.hpp"
#include "isoweave/mesh.hpp"

namespace bench {

int vtk_type(isoweave::SampleType type);

// An image without samples: the dimensions and spacing of a volume.
vtkSmartPointer<vtkImageData> empty_image(const isoweave::VolumeInfo& info);

// An image over samples that stay where they are, and must outlive it.
vtkSmartPointer<vtkImageData> image_over(const HeldVolume& volume);

vtkSmartPointer<vtkPolyData> to_polydata(const isoweave::TriangleMesh& mesh);
isoweave::TriangleMesh to_mesh(vtkPolyData* surface);

}  // namespace bench
