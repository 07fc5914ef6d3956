#include <vtkDecimatePro.h>
#include <vtkQuadricClustering.h>
#include <vtkQuadricDecimation.h>

#include <algorithm>
#include <cmath>

#include "task.hpp"
#include "vtk_data.hpp"

namespace bench {
namespace {

template <class Filter>
class VtkTask : public Task {
 public:
  explicit VtkTask(const isoweave::TriangleMesh& full) : surface_(to_polydata(full)) {
    filter_->SetInputData(surface_);
  }
  void run() override { filter_->Update(); }
  std::size_t triangles() const override { return static_cast<std::size_t>(filter_->GetOutput()->GetNumberOfPolys()); }
  isoweave::TriangleMesh mesh() const override { return to_mesh(filter_->GetOutput()); }

 protected:
  vtkSmartPointer<vtkPolyData> surface_;
  vtkSmartPointer<Filter> filter_ = vtkSmartPointer<Filter>::New();
};

// Filters that take the share of the triangles that goes.
template <class Filter>
class Reduction : public VtkTask<Filter> {
 public:
  Reduction(const isoweave::TriangleMesh& full, const Goal& goal) : VtkTask<Filter>(full) {
    const double left = static_cast<double>(goal.triangles) / static_cast<double>(full.triangles.size());
    this->filter_->SetTargetReduction(1 - left);
  }
};

// Takes the size of its cells.
class Clustering : public VtkTask<vtkQuadricClustering> {
 public:
  Clustering(const isoweave::TriangleMesh& full, const Goal& goal) : VtkTask(full) {
    const double* const bounds = surface_->GetBounds();
    const auto cells = [&](int axis) {
      const double side = bounds[2 * axis + 1] - bounds[2 * axis];
      return std::max(1, static_cast<int>(std::lround(side / goal.length)));
    };
    filter_->AutoAdjustNumberOfDivisionsOff();
    filter_->SetNumberOfDivisions(cells(0), cells(1), cells(2));
  }
};

// Below one voxel the dense array of cells of vtkQuadricClustering is larger than the volume, at 80 bytes a cell.
constexpr Steering kCellSizes{1, 100};

template <class SomeTask>
void add(Contestants& contestants, const std::string& name, std::optional<Steering> steering = std::nullopt) {
  contestants.simplifiers.push_back(
      {name, false,
       [](const isoweave::TriangleMesh& full, const Goal& goal) { return std::make_unique<SomeTask>(full, goal); },
       steering});
}

}  // namespace

void add_vtk_simplification(Contestants& contestants) {
  add<Reduction<vtkQuadricDecimation>>(contestants, "VTK quadric decimation");
  add<Reduction<vtkDecimatePro>>(contestants, "VTK decimate pro");
  add<Clustering>(contestants, "VTK quadric clustering", kCellSizes);
}

}  // namespace bench
