#include "vtk_data.hpp"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <cstring>
#include <stdexcept>

namespace bench {

int vtk_type(isoweave::SampleType type) {
  using isoweave::SampleType;
  switch (type) {
    case SampleType::kUint8:
      return VTK_UNSIGNED_CHAR;
    case SampleType::kInt8:
      return VTK_SIGNED_CHAR;
    case SampleType::kUint16:
      return VTK_UNSIGNED_SHORT;
    case SampleType::kInt16:
      return VTK_SHORT;
    case SampleType::kUint32:
      return VTK_UNSIGNED_INT;
    case SampleType::kInt32:
      return VTK_INT;
    case SampleType::kUint64:
      return VTK_UNSIGNED_LONG_LONG;
    case SampleType::kInt64:
      return VTK_LONG_LONG;
    case SampleType::kFloat32:
      return VTK_FLOAT;
    case SampleType::kFloat64:
      return VTK_DOUBLE;
  }
  return VTK_VOID;
}

vtkSmartPointer<vtkImageData> empty_image(const isoweave::VolumeInfo& info) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(info.dims[0]), static_cast<int>(info.dims[1]), static_cast<int>(info.dims[2]));
  image->SetSpacing(info.geometry.spacing.data());
  return image;
}

vtkSmartPointer<vtkImageData> image_over(const HeldVolume& volume) {
  vtkSmartPointer<vtkImageData> image = empty_image(volume.info);
  const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtk_type(volume.info.type)));
  // VTK takes the memory as its own to write to; contouring only reads it.
  void* const samples = const_cast<std::byte*>(volume.samples.data());
  array->SetVoidArray(samples, image->GetNumberOfPoints(), 1);
  image->GetPointData()->SetScalars(array);
  return image;
}

vtkSmartPointer<vtkPolyData> to_polydata(const isoweave::TriangleMesh& mesh) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    points->SetPoint(static_cast<vtkIdType>(v), mesh.vertices[v].data());
  }
  auto triangles = vtkSmartPointer<vtkCellArray>::New();
  triangles->AllocateExact(static_cast<vtkIdType>(mesh.triangles.size()),
                           static_cast<vtkIdType>(mesh.triangles.size() * 3));
  for (const auto& [a, b, c] : mesh.triangles) triangles->InsertNextCell({vtkIdType{a}, vtkIdType{b}, vtkIdType{c}});
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  return surface;
}

isoweave::TriangleMesh to_mesh(vtkPolyData* surface) {
  isoweave::TriangleMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  if (mesh.vertices.empty()) return mesh;
  vtkDataArray* const positions = surface->GetPoints()->GetData();
  if (positions->GetDataType() != VTK_FLOAT) throw std::runtime_error("expected points of VTK in single precision");
  std::memcpy(mesh.vertices.data(), positions->GetVoidPointer(0), mesh.vertices.size() * sizeof(isoweave::Point));
  mesh.triangles.reserve(static_cast<std::size_t>(surface->GetNumberOfPolys()));
  vtkCellArray* const polygons = surface->GetPolys();
  vtkIdType corners = 0;
  const vtkIdType* ids = nullptr;
  for (polygons->InitTraversal(); polygons->GetNextCell(corners, ids) != 0;) {
    if (corners != 3) continue;
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(ids[0]), static_cast<std::uint32_t>(ids[1]), static_cast<std::uint32_t>(ids[2])});
  }
  return mesh;
}

}  // namespace bench
