#include "page/page_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace isoweave::cli {
namespace {

constexpr std::array<std::uint64_t, 2> kCoarser{4, 16};  // one of so many triangles is left
constexpr std::uint64_t kFewestTriangles = 500;          // of a coarser level
constexpr double kWorthIt = 0.75;                        // part of the triangles that a level may have of the finer one
// The largest error of coarser surfaces, in parts of the one that keeps the shape: a fiftieth of the mesh's diagonal.
// Some surfaces, such as noise, cannot be made of so few triangles, and trying takes minutes.
constexpr double kMostError = 0.4;
constexpr std::size_t kBins = 40;
constexpr std::uint64_t kSamples = 200'000;

// The mesh simplified to so many triangles, or to as few as kMostError allows.
TriangleMesh simplified(const TriangleMesh& mesh, std::uint64_t triangles, const RunControl& control) {
  RunControl quiet = control;
  quiet.measure = false;
  quiet.progress = nullptr;
  MeshInMemory result(mesh.offset);
  SimplifyOptions options;
  options.error = Length::units(kMostError * most_shape_error(mesh));
  options.triangles = triangles;
  simplify_mesh(mesh, result, options, quiet);
  return result.copy();
}

PageErrors errors_of(const std::vector<float>& distances) {
  PageErrors errors;
  errors.vertices = distances.size();
  errors.counts.assign(kBins, 0);
  for (const float distance : distances) errors.max = std::max(errors.max, double{distance});
  double sum = 0;
  double squares = 0;
  for (const float distance : distances) {
    const double d = distance;
    sum += d;
    squares += d * d;
    const double part = errors.max > 0 ? d / errors.max : 0;
    ++errors.counts[std::min(static_cast<std::size_t>(part * kBins), kBins - 1)];
  }
  const auto count = static_cast<double>(distances.size());
  errors.mean = sum / count;
  errors.rms = std::sqrt(squares / count);
  return errors;
}

PageErrors measured_errors(const PageSurface& surface, const TriangleMesh& full, int threads) {
  PageErrors errors = errors_of(surface.distances);
  DistanceOptions options;
  options.samples = errors.samples = kSamples;
  options.threads = threads;
  errors.sampled = compare_meshes(surface.mesh, full, options);
  return errors;
}

// The mesh, or its stand-in, which has no distances yet.
PageSurface shown_mesh(PageSurface surface, std::uint64_t most_triangles, const RunControl& control) {
  if (surface.mesh.triangles.size() <= most_triangles) return surface;
  return {"stand-in", simplified(surface.mesh, most_triangles, control), {}, {}, {}, true};
}

void add_coarser(std::vector<PageSurface>& surfaces, const RunControl& control) {
  const std::uint64_t finest = surfaces.back().mesh.triangles.size();
  for (const std::uint64_t part : kCoarser) {
    if (finest / part < kFewestTriangles) break;
    const TriangleMesh& finer = surfaces.back().mesh;
    TriangleMesh coarser = simplified(finer, finest / part, control);
    if (static_cast<double>(coarser.triangles.size()) > kWorthIt * static_cast<double>(finer.triangles.size())) break;
    surfaces.push_back({"level", std::move(coarser)});
  }
}

// The levels of detail that are not too large, with their numbers.
std::vector<PageSurface> shown_levels(std::vector<TriangleMesh> finer, std::uint64_t most_triangles) {
  std::vector<PageSurface> levels;
  for (std::size_t level = 0; level < finer.size(); ++level) {
    if (finer[level].triangles.size() > most_triangles || finer[level].triangles.empty()) continue;
    finer[level].normals = {};
    levels.push_back({"finer", std::move(finer[level]), {}, level, {}, false});
  }
  return levels;
}

// Moves both meshes to one of their offsets. Where only one is not 0, it is that one: coordinates near it lose nothing.
void move_to_one_offset(TriangleMesh& a, TriangleMesh& b) {
  const std::array<double, 3> offset = a.offset == std::array<double, 3>{0, 0, 0} ? b.offset : a.offset;
  move_to_offset(a, offset);
  move_to_offset(b, offset);
}

}  // namespace

PageSurfaces page_surfaces(PageContents contents, std::uint64_t most_triangles, const RunControl& control) {
  PageSurfaces page;
  PageSurface surface{"mesh", std::move(contents.mesh)};
  std::optional<TriangleMesh>& full = contents.full;
  if (surface.mesh.triangles.empty()) return page;
  surface.mesh.normals = {};
  if (full) move_to_one_offset(surface.mesh, *full);
  const bool comparable = full && !full->triangles.empty();
  if (comparable) {
    surface.distances = vertex_distances(surface.mesh, *full, control.threads);
    page.errors = measured_errors(surface, *full, control.threads);
  }
  const std::size_t finer = contents.finer.size();
  for (TriangleMesh& level : contents.finer) move_to_offset(level, surface.mesh.offset);
  page.surfaces = shown_levels(std::move(contents.finer), most_triangles);
  page.lacks_finer = page.surfaces.size() < finer;
  page.surfaces.push_back(shown_mesh(std::move(surface), most_triangles, control));
  if (finer > 0) {
    page.surfaces.back().level = finer;
  } else {
    add_coarser(page.surfaces, control);
  }
  if (comparable) {
    for (PageSurface& shown : page.surfaces) {
      if (shown.distances.empty()) shown.distances = vertex_distances(shown.mesh, *full, control.threads);
    }
    page.surfaces.insert(page.surfaces.begin(), PageSurface{"full", std::move(*full)});
  }
  return page;
}

PageSurfaces iso_surfaces(std::vector<TriangleMesh> isos, std::uint64_t most_triangles, const RunControl& control) {
  PageSurfaces page;
  std::uint64_t all = 0;
  for (const TriangleMesh& mesh : isos) all += mesh.triangles.size();
  const double share = static_cast<double>(most_triangles) / static_cast<double>(std::max(all, most_triangles));
  for (std::size_t n = 0; n < isos.size(); ++n) {
    if (isos[n].triangles.empty()) continue;
    isos[n].normals = {};
    move_to_offset(isos[n], isos.front().offset);
    const auto most = static_cast<std::uint64_t>(share * static_cast<double>(isos[n].triangles.size()));
    PageSurface shown = shown_mesh({"iso", std::move(isos[n])}, std::max<std::uint64_t>(most, 1), control);
    shown.name = "iso";
    shown.iso = n;
    page.surfaces.push_back(std::move(shown));
  }
  return page;
}

}  // namespace isoweave::cli
