#include <vtkFlyingEdges3D.h>

#include <string>
#include <utility>

#include "task.hpp"
#include "vtk_data.hpp"
#include "vtk_smp.hpp"

namespace bench {
namespace {

class FlyingEdges : public Task {
 public:
  FlyingEdges(std::string backend, const HeldVolume& volume, const Goal& goal)
      : backend_(std::move(backend)), threads_(goal.threads) {
    filter_->SetInputData(image_over(volume));
    filter_->SetValue(0, stored_iso(volume.info, volume.iso));
    filter_->ComputeNormalsOff();
    filter_->ComputeScalarsOff();
  }
  void run() override {
    use_vtk_threads(backend_.c_str(), threads_);
    filter_->Update();
  }
  std::size_t triangles() const override { return static_cast<std::size_t>(filter_->GetOutput()->GetNumberOfPolys()); }
  isoweave::TriangleMesh mesh() const override { return to_mesh(filter_->GetOutput()); }

 private:
  std::string backend_;
  int threads_;
  vtkSmartPointer<vtkFlyingEdges3D> filter_ = vtkSmartPointer<vtkFlyingEdges3D>::New();
};

}  // namespace

void add_vtk_extraction(Contestants& contestants) {
  for (const std::string backend : {"TBB", "STDThread", "Sequential"}) {
    contestants.extractors.push_back({"VTK flying edges, " + backend, backend != "Sequential",
                                      [backend](const HeldVolume& volume, const Goal& goal) {
                                        return std::make_unique<FlyingEdges>(backend, volume, goal);
                                      }});
  }
}

}  // namespace bench
