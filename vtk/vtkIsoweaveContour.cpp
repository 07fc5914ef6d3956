#include "vtkIsoweaveContour.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <isoweave/error.hpp>
#include <isoweave/measure.hpp>
#include <isoweave/pipeline.hpp>
#include <memory>
#include <span>
#include <stdexcept>

vtkStandardNewMacro(vtkIsoweaveContour);

namespace {

// Integers by their size, as VTK has several names for the same type, and `char` is signed on some machines only.
isoweave::SampleType type_of(vtkDataArray& samples) {
  using isoweave::SampleType;
  if (samples.GetDataType() == VTK_FLOAT) return SampleType::kFloat32;
  if (samples.GetDataType() == VTK_DOUBLE) return SampleType::kFloat64;
  const bool is_signed = samples.GetDataTypeMin() < 0;
  switch (samples.GetDataType() == VTK_BIT ? 0 : samples.GetDataTypeSize()) {
    case 1:
      return is_signed ? SampleType::kInt8 : SampleType::kUint8;
    case 2:
      return is_signed ? SampleType::kInt16 : SampleType::kUint16;
    case 4:
      return is_signed ? SampleType::kInt32 : SampleType::kUint32;
    case 8:
      return is_signed ? SampleType::kInt64 : SampleType::kUint64;
    default:
      throw std::invalid_argument(std::string("expected scalars of whole bytes, found ") +
                                  samples.GetDataTypeAsString());
  }
}

// The place of the first sample of the extent, and the axes. Where VTK counts an axis backwards by a negative spacing,
// its direction is turned.
isoweave::Geometry geometry_of(vtkImageData& image) {
  isoweave::Geometry geometry;
  const int* extent = image.GetExtent();
  image.TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], geometry.origin.data());
  const double* direction = image.GetDirectionMatrix()->GetData();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double spacing = image.GetSpacing()[axis];
    geometry.spacing[axis] = std::abs(spacing);
    for (std::size_t row = 0; row < 3; ++row) {
      geometry.direction[3 * row + axis] = std::copysign(1.0, spacing) * direction[3 * row + axis];
    }
  }
  return geometry;
}

isoweave::VolumeInfo info_of(vtkImageData& image, vtkDataArray& samples) {
  isoweave::VolumeInfo info;
  info.path = samples.GetName() != nullptr ? samples.GetName() : "image";
  info.format = "vtkImageData";
  std::copy_n(image.GetDimensions(), 3, info.dims.begin());
  info.type = type_of(samples);
  info.geometry = geometry_of(image);
  return info;
}

// The samples in one block, as all arrays of VTK's own are.
vtkSmartPointer<vtkDataArray> in_one_block(vtkDataArray* samples) {
  if (samples == nullptr) throw std::invalid_argument("expected an image with point scalars, found none");
  if (samples->GetNumberOfComponents() != 1) {
    throw std::invalid_argument("expected scalars of one component, found " +
                                std::to_string(samples->GetNumberOfComponents()));
  }
  if (samples->HasStandardMemoryLayout()) return samples;
  auto block = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(samples->GetDataType()));
  block->DeepCopy(samples);
  return block;
}

// An array of VTK with the rows of a span, each moved by an offset.
template <class Array>
vtkSmartPointer<Array> rows(std::span<const isoweave::Point> from, const std::array<double, 3>& offset = {}) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(from.size()));
  auto* to = array->GetPointer(0);
  for (const isoweave::Point& point : from) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      *to++ = static_cast<typename Array::ValueType>(offset[axis] + static_cast<double>(point[axis]));
    }
  }
  return array;
}

// Coordinates are of 64 bits where 32 bits would lose the shape.
vtkSmartPointer<vtkDataArray> points_of(const isoweave::MeshInMemory& mesh) {
  const std::array<double, 3> offset = mesh.offset();
  if (offset == std::array<double, 3>{}) return rows<vtkFloatArray>(mesh.vertices());
  return rows<vtkDoubleArray>(mesh.vertices(), offset);
}

vtkSmartPointer<vtkCellArray> polys_of(const isoweave::MeshInMemory& mesh) {
  vtkNew<vtkTypeInt64Array> corners;
  corners->SetNumberOfValues(3 * static_cast<vtkIdType>(mesh.triangles().size()));
  vtkTypeInt64* to = corners->GetPointer(0);
  for (const auto& triangle : mesh.triangles()) to = std::ranges::copy(triangle, to).out;
  auto polys = vtkSmartPointer<vtkCellArray>::New();
  polys->SetData(3, corners);
  return polys;
}

void fill(vtkPolyData& output, const isoweave::MeshInMemory& mesh) {
  vtkNew<vtkPoints> points;
  points->SetData(points_of(mesh));
  output.SetPoints(points);
  output.SetPolys(polys_of(mesh));
  if (mesh.normals().empty()) return;
  const auto normals = rows<vtkFloatArray>(mesh.normals());
  normals->SetName("Normals");
  output.GetPointData()->SetNormals(normals);
}

}  // namespace

vtkIsoweaveContour::vtkIsoweaveContour()
    : Value(0), Error("0.2vox"), Closed(true), ComputeNormals(false), NumberOfThreads(0) {
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkIsoweaveContour::~vtkIsoweaveContour() = default;

void vtkIsoweaveContour::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Value: " << this->Value << '\n'
     << indent << "Error: " << this->Error << '\n'
     << indent << "Closed: " << this->Closed << '\n'
     << indent << "ComputeNormals: " << this->ComputeNormals << '\n'
     << indent << "NumberOfThreads: " << this->NumberOfThreads << '\n'
     << indent << "Digest: " << this->Digest << '\n';
}

int vtkIsoweaveContour::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

// A part of the image would have another surface at its sides.
int vtkIsoweaveContour::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*) {
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* input = inputs[0]->GetInformationObject(0);
  input->Set(Pipeline::UPDATE_EXTENT(), input->Get(Pipeline::WHOLE_EXTENT()), 6);
  return 1;
}

int vtkIsoweaveContour::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) {
  this->Digest.clear();
  vtkImageData* image = vtkImageData::GetData(inputs[0]);
  if (image->GetNumberOfPoints() == 0) return 1;
  try {
    const auto samples = in_one_block(this->GetInputArrayToProcess(0, inputs));
    const isoweave::VolumeInfo info = info_of(*image, *samples);
    const auto bytes = static_cast<std::size_t>(samples->GetNumberOfValues() * samples->GetDataTypeSize());
    const auto volume =
        isoweave::volume_in_memory(info, {static_cast<const std::byte*>(samples->GetVoidPointer(0)), bytes});
    isoweave::MeshOptions options;
    options.iso = this->Value;
    options.error = isoweave::parse_length(this->Error, "");
    options.closed = this->Closed;
    options.normals = this->ComputeNormals ? isoweave::Normals::kGradient : isoweave::Normals::kAbsent;
    const auto stop = std::make_shared<std::atomic<bool>>(false);
    isoweave::RunControl control;
    control.threads = this->NumberOfThreads;
    control.stop = stop;
    control.progress = [&](const isoweave::Progress& progress) {
      this->UpdateProgress(static_cast<double>(progress.layer) / static_cast<double>(progress.layers));
      if (this->GetAbortExecute() != 0) *stop = true;
    };
    isoweave::MeshInMemory mesh(isoweave::mesh_offset(info, options.space));
    const isoweave::MeshReport report = isoweave::mesh_volume(*volume, mesh, options, control);
    fill(*vtkPolyData::GetData(outputs), mesh);
    this->Digest = isoweave::digest_text(report.digest);
    return 1;
  } catch (const isoweave::Interrupted&) {
    return 1;  // aborted: the output is empty, as that of VTK's own filters
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  } catch (...) {  // from an observer of the program
    vtkErrorMacro("expected an observer without exceptions, found one of a kind of its own");
    return 0;
  }
}
