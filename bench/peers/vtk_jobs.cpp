// The whole job as VTK's users do it: a raw file read at once, flying edges on all threads, decimation.
#include "vtk_jobs.hpp"

#include <vtkFlyingEdges3D.h>
#include <vtkPointData.h>
#include <vtkQuadricDecimation.h>

#include <fstream>
#include <stdexcept>

#include "task.hpp"
#include "vtk_data.hpp"
#include "vtk_smp.hpp"

namespace bench {
namespace {

vtkSmartPointer<vtkImageData> read_image(const VolumeFile& file) {
  vtkSmartPointer<vtkImageData> image = empty_image(file.info);
  image->AllocateScalars(vtk_type(file.info.type), 1);
  const std::streamsize bytes = static_cast<std::streamsize>(file.info.slice_bytes()) * file.info.dims[2];
  std::ifstream stream(file.info.path, std::ios::binary);
  if (!stream.read(static_cast<char*>(image->GetScalarPointer()), bytes)) {
    throw std::runtime_error("cannot read " + file.info.path);
  }
  return image;
}

class QuadricJob : public Task {
 public:
  QuadricJob(const VolumeFile& file, const Goal& goal) : file_(file), goal_(goal) {}
  void run() override {
    const vtkSmartPointer<vtkPolyData> full = flying_edges(file_, goal_.threads);
    const auto filter = vtkSmartPointer<vtkQuadricDecimation>::New();
    filter->SetInputData(full);
    const double left = static_cast<double>(goal_.triangles) / static_cast<double>(full->GetNumberOfPolys());
    filter->SetTargetReduction(1 - left);
    filter->Update();
    result_ = filter->GetOutput();
  }
  std::size_t triangles() const override { return static_cast<std::size_t>(result_->GetNumberOfPolys()); }
  isoweave::TriangleMesh mesh() const override { return to_mesh(result_); }

 private:
  const VolumeFile& file_;
  Goal goal_;
  vtkSmartPointer<vtkPolyData> result_;
};

}  // namespace

vtkSmartPointer<vtkPolyData> flying_edges(const VolumeFile& file, int threads) {
  use_vtk_threads("TBB", threads);
  const auto filter = vtkSmartPointer<vtkFlyingEdges3D>::New();
  filter->SetInputData(read_image(file));
  filter->SetValue(0, file.iso);
  filter->ComputeNormalsOff();
  filter->ComputeScalarsOff();
  filter->Update();
  return filter->GetOutput();
}

void add_vtk_jobs(Contestants& contestants) {
  contestants.jobs.push_back(
      {"VTK flying edges + quadric decimation", true,
       [](const VolumeFile& file, const Goal& goal) { return std::make_unique<QuadricJob>(file, goal); }});
}

}  // namespace bench
