// The filter in a pipeline of VTK: where the mesh lies, progress, abort, errors, other arrays. Writes the image that
// the command line is compared with: filter IMAGE.vti. Exits with the number of failures.
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkShortArray.h>
#include <vtkXMLImageDataWriter.h>

#include <cmath>
#include <cstring>
#include <iostream>
#include <string>

#include "vtkIsoweaveContour.h"

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::cerr << "expected: " << what << '\n';
  ++failures;
}

double value(int i, int j, int k) { return 100 - 6 * std::hypot(i - 20.3, j - 11.8, k - 17.1) + 9 * std::sin(0.9 * i); }

// A dented ball in an image whose extent begins anywhere, turned, and at a place of its own.
vtkNew<vtkImageData> image() {
  vtkNew<vtkImageData> made;
  made->SetExtent(3, 42, -5, 30, 2, 33);
  made->SetSpacing(0.5, 0.75, 1.25);
  made->SetOrigin(-7, 11, 3);
  made->SetDirectionMatrix(0, -1, 0, 0.8, 0, -0.6, 0.6, 0, 0.8);
  made->AllocateScalars(VTK_SHORT, 1);
  auto* sample = static_cast<short*>(made->GetScalarPointer());
  for (int k = 2; k <= 33; ++k) {
    for (int j = -5; j <= 30; ++j) {
      for (int i = 3; i <= 42; ++i) *sample++ = static_cast<short>(std::lround(10 * value(i, j, k)));
    }
  }
  made->GetPointData()->GetScalars()->SetName("ct");
  return made;
}

// Where the samples say that the surface is, by VTK's own interpolation.
void check_places(vtkImageData& input, vtkPolyData& surface) {
  expect(surface.GetNumberOfPolys() > 100, "triangles");
  double farthest = 0;
  for (vtkIdType n = 0; n < surface.GetNumberOfPoints(); ++n) {
    double index[3];
    input.TransformPhysicalPointToContinuousIndex(surface.GetPoint(n), index);
    const double i = index[0];
    const double radius = std::hypot(i - 20.3, index[1] - 11.8, index[2] - 17.1);
    farthest = std::max(farthest, std::abs(100 - 6 * radius + 9 * std::sin(0.9 * i) - 25) / 6);
  }
  expect(farthest < 0.5, "points within half a voxel of the formula's surface");
}

// Normals leave the ball, whose middle is known.
void check_normals(vtkImageData& input, vtkPolyData& surface) {
  vtkDataArray* normals = surface.GetPointData()->GetNormals();
  expect(normals != nullptr && normals->GetNumberOfTuples() == surface.GetNumberOfPoints(), "a normal for each point");
  double middle[3];
  input.TransformContinuousIndexToPhysicalPoint(20.3, 11.8, 17.1, middle);
  vtkIdType outwards = 0;
  for (vtkIdType n = 0; n < surface.GetNumberOfPoints(); ++n) {
    double point[3];
    surface.GetPoint(n, point);
    double along = 0;
    for (int axis = 0; axis < 3; ++axis) along += (point[axis] - middle[axis]) * normals->GetComponent(n, axis);
    outwards += along > 0 ? 1 : 0;
  }
  expect(outwards > 9 * surface.GetNumberOfPoints() / 10, "normals that point outwards");
}

struct Heard {
  int progress = 0, errors = 0;
  bool abort = false;
  std::string text;
};

void listen(vtkObject* caller, unsigned long event, void* client, void* data) {
  auto& heard = *static_cast<Heard*>(client);
  if (event == vtkCommand::ErrorEvent) {
    ++heard.errors;
    heard.text = static_cast<const char*>(data);
    return;
  }
  ++heard.progress;
  if (heard.abort) static_cast<vtkAlgorithm*>(caller)->AbortExecuteOn();
}

vtkNew<vtkCallbackCommand> listener(Heard& heard) {
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(listen);
  command->SetClientData(&heard);
  return command;
}

void check_pipeline(vtkImageData& input) {
  Heard heard;
  vtkNew<vtkIsoweaveContour> contour;
  const auto command = listener(heard);
  contour->AddObserver(vtkCommand::ProgressEvent, command);
  contour->AddObserver(vtkCommand::ErrorEvent, command);
  contour->SetInputData(&input);
  contour->SetValue(250);
  contour->ComputeNormalsOn();
  contour->SetNumberOfThreads(1);
  contour->Update();
  const std::string digest = contour->GetDigest();
  expect(digest.size() == 16 && heard.progress >= 2 && heard.errors == 0, "a mesh, and progress on the way");
  check_places(input, *contour->GetOutput());
  check_normals(input, *contour->GetOutput());

  contour->SetError("0.1furlong");
  contour->Update();
  expect(heard.errors > 0 && heard.text.find("0.1furlong") != std::string::npos, "an error of the pipeline");
  expect(contour->GetOutput()->GetNumberOfPoints() == 0 && *contour->GetDigest() == '\0', "no mesh after an error");

  heard = {};
  heard.abort = true;
  contour->SetError("0.2vox");
  contour->Update();
  expect(heard.progress >= 1 && heard.errors == 0, "an abort that is no error");
  expect(contour->GetOutput()->GetNumberOfPoints() == 0 && *contour->GetDigest() == '\0', "no mesh after an abort");

  heard.abort = false;
  contour->Modified();
  contour->Update();
  expect(contour->GetDigest() == digest, "the same mesh after an abort");
  contour->ClosedOff();
  contour->SetValue(-350);
  contour->Update();
  const std::string open = contour->GetDigest();
  contour->ClosedOn();
  contour->Update();
  expect(!open.empty() && open != contour->GetDigest(), "caps where the surface meets the border, and none if open");
}

// The same samples in an array with another layout, and as floats by another name.
void check_arrays(vtkImageData& input) {
  vtkNew<vtkIsoweaveContour> contour;
  contour->SetInputData(&input);
  contour->SetValue(250);
  contour->Update();
  const std::string digest = contour->GetDigest();
  const vtkIdType count = input.GetNumberOfPoints();
  vtkNew<vtkSOADataArrayTemplate<short>> apart;
  vtkNew<vtkFloatArray> floats;
  vtkNew<vtkShortArray> pairs;
  for (vtkDataArray* array : {static_cast<vtkDataArray*>(apart), static_cast<vtkDataArray*>(floats)}) {
    array->SetNumberOfComponents(1);
    array->SetNumberOfTuples(count);
    for (vtkIdType n = 0; n < count; ++n) array->SetTuple1(n, input.GetPointData()->GetScalars()->GetTuple1(n));
  }
  pairs->SetNumberOfComponents(2);
  pairs->SetNumberOfTuples(count);
  floats->SetName("floats");
  pairs->SetName("pairs");
  vtkNew<vtkImageData> other;
  other->CopyStructure(&input);
  other->GetPointData()->SetScalars(apart);
  other->GetPointData()->AddArray(floats);
  other->GetPointData()->AddArray(pairs);
  contour->SetInputData(other);
  contour->Update();
  expect(contour->GetDigest() == digest, "the mesh of an array of another layout");
  const auto choose = [&](const char* name) {
    contour->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
    contour->Update();
  };
  choose("floats");
  expect(contour->GetDigest() == digest, "the mesh of the array that was chosen");
  Heard heard;
  contour->AddObserver(vtkCommand::ErrorEvent, listener(heard));
  choose("pairs");
  expect(heard.errors > 0 && heard.text.find("one component, found 2") != std::string::npos, "no mesh of pairs");
}

// An axis that is counted backwards: the same samples at the same places.
void check_turned_axis(vtkImageData& input) {
  vtkNew<vtkImageData> turned;
  turned->ShallowCopy(&input);
  const vtkMatrix3x3& direction = *input.GetDirectionMatrix();
  turned->SetDirectionMatrix(-direction.GetElement(0, 0), direction.GetElement(0, 1), direction.GetElement(0, 2),
                             -direction.GetElement(1, 0), direction.GetElement(1, 1), direction.GetElement(1, 2),
                             -direction.GetElement(2, 0), direction.GetElement(2, 1), direction.GetElement(2, 2));
  turned->SetSpacing(-input.GetSpacing()[0], input.GetSpacing()[1], input.GetSpacing()[2]);
  vtkNew<vtkIsoweaveContour> contour;
  contour->SetValue(250);
  contour->SetInputData(&input);
  contour->Update();
  const std::string digest = contour->GetDigest();
  contour->SetInputData(turned);
  contour->Update();
  expect(contour->GetDigest() == digest, "the same mesh where an axis is counted backwards");
}

}  // namespace

int main(int argc, char** argv) {
  const vtkNew<vtkImageData> input = image();
  check_pipeline(*input);
  check_arrays(*input);
  check_turned_axis(*input);
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(input);
  writer->SetFileName(argc > 1 ? argv[1] : "image.vti");
  expect(writer->Write() == 1, "an image that can be written");
  return failures;
}
