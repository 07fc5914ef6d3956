// Previews: the loop over a volume or a mesh, with clusters in the place of the simplifier.
#include "isoweave/preview.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cluster/clusters.hpp"
#include "files/header_text.hpp"
#include "isoweave/measure.hpp"
#include "output/world.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/mesh_surface.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/volume_sweep.hpp"
#include "system/process_memory.hpp"
#include "volume/axes.hpp"

namespace isoweave {
namespace {

constexpr double kLeastVoxels = 2;   // along the side of a usual cell
constexpr double kCellsAlong = 256;  // of the usual size, along the longest side at most
constexpr double kMost = static_cast<double>(CellGrid::kMostCells) / 2;  // cells along the longest side
constexpr std::size_t kTriangles = 1 << 16;                              // that a sink gets at a time

// The side of a cell. voxel: the unit of lengths in voxels.
double cell_side(const Length& asked, double longest, double voxel) {
  const double usual = std::max(kLeastVoxels * voxel, longest / kCellsAlong);
  const double side = asked.value == 0 ? usual : asked.value * (asked.in_voxels ? voxel : 1);
  const double least = longest / kMost;
  if (side >= least && side > 0 && std::isfinite(side)) return side;
  throw std::invalid_argument("preview: expected a cell of at least " + rounded_text(least) + ", found " +
                              rounded_text(side));
}

CellGrid grid_of(const VolumeInfo& volume, const Length& cell) {
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, volume.geometry.spacing[axis] * static_cast<double>(volume.dims[axis]));
  }
  return {Vec3{}, cell_side(cell, longest, mean_voxel(volume.geometry))};
}

// The cells begin at the least corner of the box around the vertices.
CellGrid grid_of(const TriangleMesh& mesh, const Length& cell, const Executor& executor) {
  std::array<double, 3> low{};
  double longest = 0;
  for (std::size_t axis = 0; axis < 3 && !mesh.vertices.empty(); ++axis) {
    const auto [least, most] = std::ranges::minmax(mesh.vertices, {}, [&](const Point& p) { return p[axis]; });
    low[axis] = least[axis];
    longest = std::max(longest, double{most[axis]} - double{least[axis]});
  }
  const double area = mean_triangle_area(mesh, executor);
  return {{low[0], low[1], low[2]}, cell_side(cell, longest, area > 0 ? std::sqrt(2 * area) : 1)};
}

void require_finite(const TriangleMesh& mesh) {
  for (const Point& p : mesh.vertices) {
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
    throw std::invalid_argument("preview: expected finite coordinates of a mesh");
  }
}

// The surface at its place in the output.
TriangleMesh placed(ClusteredSurface& surface, const World& world) {
  TriangleMesh mesh;
  mesh.offset = world.offset();
  mesh.vertices.reserve(surface.positions.size());
  for (const Vec3& position : surface.positions) mesh.vertices.push_back(world.point(position));
  mesh.triangles = std::move(surface.triangles);
  if (!world.mirrors()) return mesh;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

void write(const TriangleMesh& mesh, MeshSink& sink) {
  sink.append({.vertices = mesh.vertices});
  std::vector<std::array<std::uint64_t, 3>> triangles;
  for (std::size_t first = 0; first < mesh.triangles.size(); first += kTriangles) {
    triangles.clear();
    const std::size_t end = std::min(first + kTriangles, mesh.triangles.size());
    for (std::size_t n = first; n < end; ++n) {
      const auto& t = mesh.triangles[n];
      triangles.push_back({t[0], t[1], t[2]});
    }
    sink.append({.triangles = triangles});
  }
}

void report_checked(const TriangleMesh& mesh, MeshReport& report) {
  const MeshCheck check = check_mesh(mesh);
  report.open_edges = check.open_edges;
  report.nonmanifold_edges = check.nonmanifold_edges;
  report.nonmanifold_vertices = check.nonmanifold_vertices;
  report.components = check.components;
  report.euler = check.euler;
  report.digest = check.digest;
}

// Writes what the clusters have become, and tells of it.
void deliver(Clusters& clusters, const CellGrid& grid, const World& world, const RunControl& control, MeshSink& sink,
             MeshReport& report) {
  Stopwatch clock;
  ClusteredSurface surface = clusters.finish();
  report.preview = {grid.side(), surface.rms, surface.cells, surface.collapsed, surface.repeated};
  const TriangleMesh mesh = placed(surface, world);
  report.triangles = mesh.triangles.size();
  report.vertices = mesh.vertices.size();
  clock.lap(report.seconds_simplify);
  if (control.measure) report_checked(mesh, report);
  write(mesh, sink);
  clock.lap(report.seconds_write);
}

// The reason why a preview has no triangles though the surface has some.
std::string all_collapsed(const MeshReport& report) {
  return "nothing is left: no triangle of the surface has corners in three cells of " +
         rounded_text(report.preview->cell);
}

void finish(MeshSink& sink, MeshReport& report) {
  Stopwatch clock;
  sink.finish();
  clock.lap(report.seconds_write);
}

MeshOptions surface_of(const PreviewOptions& options) {
  MeshOptions surface = full_surface(options);
  surface.space = options.space;
  return surface;
}

class VolumePreview {
 public:
  VolumePreview(SliceSource& volume, MeshSink& sink, const PreviewOptions& options, const RunControl& control)
      : task_(resolve(volume.info(), surface_of(options), control, sink.offset(), RunKind::kPreview)),
        control_(control),
        grid_(grid_of(task_.volume, options.cell)),
        identity_(identity_of(task_)),
        sink_(sink),
        sweep_(volume, task_, control_, report_),
        world_(task_.volume.geometry, task_.space, task_.offset),
        extractor_(sweep_.make_extractor()),
        clusters_(grid_, sweep_.executor()) {}

  MeshReport run() {
    Stopwatch total;
    report_.threads = sweep_.executor().threads();
    report_.slab = control_.slab;
    report_.device = Device::kCpu;
    warn_of_space(task_, report_);
    warn_of_rounding(task_, report_);
    sweep_.begin(*extractor_, {&clusters_}, nullptr);
    sweep_.open();
    while (!sweep_.complete()) {
      check_stop(control_);
      sweep_.step();
    }
    deliver(clusters_, grid_, world_, control_, sink_, report_);
    sweep_.finish();
    warn();
    require_unchanged(task_, identity_);
    finish(sink_, report_);
    total.lap(report_.seconds_total);
    report_.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

 private:
  void warn() {
    warn_of_border(task_, report_);
    if (report_.triangles > 0 || report_.triangles_extracted == 0) {
      warn_of_nothing(task_, control_.allow_empty, report_);
    } else {
      report_nothing(task_.volume.path + ": " + all_collapsed(report_), control_.allow_empty, report_);
    }
  }

  const Task task_;
  const RunControl& control_;
  const CellGrid grid_;
  const RunIdentity identity_;
  MeshSink& sink_;
  MeshReport report_;
  VolumeSweep sweep_;
  const World world_;
  std::unique_ptr<Extractor> extractor_;
  Clusters clusters_;
};

// Takes the pieces of a mesh. Returns the number of triangles that were left out.
std::uint64_t sweep(const TriangleMesh& mesh, const RunControl& control, const Executor& executor, Clusters& clusters,
                    MeshReport& report) {
  const MeshSurface::Pieces pieces{
      .triangles = control.piece > 0 ? control.piece : static_cast<std::uint64_t>(kFullSlab.triangles),
      .exactly = control.piece > 0};
  MeshSurface source(mesh, executor, pieces);
  Loop loop(source, {&clusters}, nullptr, report);
  do {
    check_stop(control);
    loop.step();
  } while (!loop.complete());
  return source.dropped();
}

void warn_of_mesh(const TriangleMesh& mesh, const World& world, std::uint64_t dropped, MeshReport& report) {
  const auto warn = [&](const std::string& text) { report.warnings.push_back(text); };
  if (world.offset() != mesh.offset) {
    warn("coordinates were rounded to 32 bits anew, as the sink was opened with another offset than the mesh has");
  }
  if (dropped > 0) warn(std::to_string(dropped) + " triangles that repeat a vertex are left out");
  if (!mesh.normals.empty()) warn("the normals of the mesh are not kept");
  if (!mesh.values.empty()) warn("the values of the mesh are not kept");
}

}  // namespace

MeshReport preview_volume(SliceSource& volume, MeshSink& sink, const PreviewOptions& options,
                          const RunControl& control) {
  const StandardFloats floats;
  return VolumePreview(volume, sink, options, control).run();
}

MeshReport preview_mesh(const TriangleMesh& mesh, MeshSink& sink, const Length& cell, const RunControl& control) {
  const StandardFloats floats;
  require_possible(RunKind::kPreview, {}, control);
  require_finite(mesh);
  Stopwatch total;
  const Executor executor(control.threads);
  const CellGrid grid = grid_of(mesh, cell, executor);
  const World world(mesh.offset, sink.offset());
  Clusters clusters(grid, executor);
  MeshReport report;
  report.threads = executor.threads();
  const std::uint64_t dropped = sweep(mesh, control, executor, clusters, report);
  deliver(clusters, grid, world, control, sink, report);
  warn_of_mesh(mesh, world, dropped, report);
  if (report.triangles == 0) {
    report_nothing(mesh.triangles.empty() ? "the mesh has no triangles" : all_collapsed(report), control.allow_empty,
                   report);
  }
  finish(sink, report);
  total.lap(report.seconds_total);
  report.peak_bytes = system::peak_bytes();
  return report;
}

}  // namespace isoweave
