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

MeshDistance sampled_distance(const TriangleMesh& mesh, const TriangleMesh& full, int threads) {
  DistanceOptions options;
  options.samples = kSamples;
  options.threads = threads;
  return compare_meshes(mesh, full, options);
}

PageSurface stand_in(const TriangleMesh& mesh, std::uint64_t most_triangles, const RunControl& control) {
  return {"stand-in", simplified(mesh, most_triangles, control), {}, {}, {}, true};
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

// Measures meshes, which have one offset, from the surface before simplification.
class FullSurface {
 public:
  FullSurface(const PageContents& contents, int threads) : contents_(contents), threads_(threads) {}

  std::vector<std::vector<float>> distances_of(const std::vector<const TriangleMesh*>& meshes) const {
    if (contents_.full_pass) return piece_distances(meshes, contents_.full_pass, threads_);
    std::vector<std::vector<float>> distances;
    distances.reserve(meshes.size());
    for (const TriangleMesh* mesh : meshes) distances.push_back(vertex_distances(*mesh, *contents_.full, threads_));
    return distances;
  }

  // Between the surfaces only where the full one is held.
  PageErrors errors_of_mesh(const TriangleMesh& mesh, const std::vector<float>& distances) const {
    PageErrors errors = errors_of(distances);
    if (contents_.full_pass) return errors;
    errors.samples = kSamples;
    errors.sampled = sampled_distance(mesh, *contents_.full, threads_);
    return errors;
  }

 private:
  const PageContents& contents_;
  int threads_;
};

// Gives the surfaces their distances from the full one. `whole`: the mesh where a surface stands in for it, or none.
void measure(PageSurfaces& page, const TriangleMesh& whole, const FullSurface& full) {
  std::vector<const TriangleMesh*> meshes;
  for (const PageSurface& shown : page.surfaces) meshes.push_back(&shown.mesh);
  if (!whole.triangles.empty()) meshes.push_back(&whole);
  std::vector<std::vector<float>> distances = full.distances_of(meshes);
  const auto mesh = whole.triangles.empty()
                        ? std::ranges::find(page.surfaces, "mesh", &PageSurface::name) - page.surfaces.begin()
                        : std::ssize(meshes) - 1;
  const auto n = static_cast<std::size_t>(mesh);
  page.errors = full.errors_of_mesh(*meshes[n], distances[n]);
  for (std::size_t s = 0; s < page.surfaces.size(); ++s) page.surfaces[s].distances = std::move(distances[s]);
}

}  // namespace

PageSurfaces page_surfaces(PageContents contents, std::uint64_t most_triangles, const RunControl& control) {
  PageSurfaces page;
  if (contents.mesh.triangles.empty()) return page;
  contents.mesh.normals = {};
  std::optional<TriangleMesh>& full = contents.full;
  if (full) move_to_one_offset(contents.mesh, *full);
  const bool comparable = full && !full->triangles.empty();
  const std::size_t finer = contents.finer.size();
  for (TriangleMesh& level : contents.finer) move_to_offset(level, contents.mesh.offset);
  page.surfaces = shown_levels(std::move(contents.finer), most_triangles);
  page.lacks_finer = page.surfaces.size() < finer;
  TriangleMesh whole;
  if (contents.mesh.triangles.size() > most_triangles) whole = std::move(contents.mesh);
  page.surfaces.push_back(whole.triangles.empty() ? PageSurface{"mesh", std::move(contents.mesh)}
                                                  : stand_in(whole, most_triangles, control));
  if (finer > 0) {
    page.surfaces.back().level = finer;
  } else {
    add_coarser(page.surfaces, control);
  }
  if (comparable) {
    measure(page, whole, FullSurface(contents, control.threads));
    page.full_triangles = contents.full_triangles;
    if (full->triangles.size() > kMostFullTriangles) {
      page.full_triangles = full->triangles.size();
      full = simplified(*full, kMostFullTriangles, control);
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
    PageSurface shown{"iso", std::move(isos[n])};
    if (shown.mesh.triangles.size() > most) shown = stand_in(shown.mesh, std::max<std::uint64_t>(most, 1), control);
    shown.name = "iso";
    shown.iso = n;
    page.surfaces.push_back(std::move(shown));
  }
  return page;
}

}  // namespace isoweave::cli
