#include "pipeline/sweep.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "isoweave/error.hpp"
#include "lattice/lattice.hpp"
#include "output/world.hpp"
#include "volume/axes.hpp"
#include "volume/samples.hpp"
#include "volume/threshold.hpp"

namespace isoweave {

double cube_root(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  while (exponent % 3 != 0) {
    mantissa *= 2;
    --exponent;
  }
  double root = 1;
  for (int step = 0; step < 8; ++step) root = (2 * root + mantissa / (root * root)) / 3;
  return std::ldexp(root, exponent / 3);
}

double mean_voxel(const Geometry& geometry) {
  return cube_root(geometry.spacing[0] * geometry.spacing[1] * geometry.spacing[2]);
}

double length_in(const VolumeInfo& volume, const Length& length) {
  return length.value * (length.voxels ? mean_voxel(volume.geometry) : 1);
}

const VolumeInfo& checked_volume(const VolumeInfo& volume) {
  require_usable(volume);
  if (!Lattice::fits(volume.dims)) {
    throw BadInput(volume.path + ": expected fewer than 2^54 samples, found " + std::to_string(volume.dims[0]) + " x " +
                   std::to_string(volume.dims[1]) + " x " + std::to_string(volume.dims[2]));
  }
  return volume;
}

bool simplifies(const VolumeInfo& volume, const MeshOptions& options) {
  const bool has_cells = options.closed || std::ranges::min(volume.dims) > 1;
  return options.error.value > 0 || !has_cells;
}

ZoneOptions zone_options(const VolumeInfo& volume, const MeshOptions& options) {
  const Lattice lattice{volume.dims};
  const double voxel = mean_voxel(volume.geometry);
  const double a0 = voxel * voxel;
  const auto& spacing = volume.geometry.spacing;
  const Vec3 cell{spacing[0], spacing[1], spacing[2]};
  return {{lattice.row(), lattice.plane()},
          a0,
          retire_cost(length_in(volume, options.error), a0, options.triangles),
          options.drop_specks,
          most_distance(options.max_distance, voxel),
          cell,
          cell,
          options.normals == Normals::kQuadric,
          options.quality};
}

IsoRule stored_rule(const VolumeInfo& volume, const MeshOptions& options) {
  if (!std::isfinite(options.iso)) throw std::invalid_argument("iso: expected a finite number");
  IsoRule rule;
  rule.iso = (options.iso - volume.intercept) / volume.slope;
  rule.above = options.inside_above == (volume.slope > 0);
  rule.closed = options.closed;
  return rule;
}

bool is_inside(const SampleBytes& sample, SampleType type, const IsoRule& rule) {
  return visit_sample_type(type, [&]<class T>() {
    T stored{};
    std::memcpy(&stored, sample.data(), sizeof stored);
    const Threshold<T> threshold = threshold_for<T>(rule.iso, rule.above);
    return threshold.reachable && (rule.above ? stored >= threshold.value : stored <= threshold.value);
  });
}

CostBits retire_cost(double error, double a0, std::uint64_t triangles) {
  if (std::isinf(error) && error > 0 && triangles > 0) return kRetiredCost - 1;
  if (!(error >= 0) || std::isinf(error)) {
    throw std::invalid_argument("error: expected a length of 0 or more, found " + std::to_string(error));
  }
  // Edges whose keys are not known yet have cost 0 and must stay live, also when nothing is simplified.
  return error > 0 ? to_cost(error * error / a0) : kUnknownCost;
}

namespace {

constexpr std::uint64_t kLeastTriangles = 4;  // of a closed component
constexpr double kShapePart = 0.05;           // of a diagonal

std::string short_number(double number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), number, std::chars_format::general, 4);
  return {digits.begin(), end.ptr};
}

// Why more triangles are left than a run was to stop at.
std::string why_more_are_left(const MeshReport& report, std::uint64_t asked, double most_error, std::string_view unit) {
  const std::string length = short_number(most_error) + (unit.empty() ? "" : " ") + std::string(unit);
  const std::string within = std::isfinite(most_error) ? " within an error of " + length : "";
  std::string held = "no other collapse" + within + " keeps the topology and the sides of faces";
  const std::uint64_t least = kLeastTriangles * report.components;
  if (report.open_edges > 0 || least <= asked) return held;
  const std::string kept = "each of " + std::to_string(report.components) + " components keeps " +
                           std::to_string(kLeastTriangles) + " at least, " + std::to_string(least) + " in all";
  return report.triangles > least ? kept + "; " + held : kept;
}

}  // namespace

void report_target(const Simplifier& simplifier, std::uint64_t asked, double side, std::string_view unit,
                   MeshReport& report) {
  const double most_error = report.error;
  const auto dearest = static_cast<CostBits>(simplifier.counts().dearest);
  // Lower costs are all the same.
  const bool none = dearest <= cost_bits(kCostFloor);
  report.error = none ? 0 : side * std::sqrt(static_cast<double>(cost_value(dearest)));
  if (report.triangles <= asked) return;
  report.warnings.push_back(std::to_string(report.triangles) + " triangles are left, " + std::to_string(asked) +
                            " were asked for: " + why_more_are_left(report, asked, most_error, unit));
}

double most_shape_error(const VolumeInfo& volume) {
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double side = volume.geometry.spacing[axis] * static_cast<double>(volume.dims[axis]);
    squared += side * side;
  }
  return kShapePart * std::sqrt(squared);
}

double most_shape_error(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::ranges::minmax(mesh.vertices, {}, [&](const Point& p) { return p[axis]; });
    const double side = double{high[axis]} - double{low[axis]};
    squared += side * side;
  }
  return kShapePart * std::sqrt(squared);
}

void warn_of_space(const VolumeInfo& volume, const MeshOptions& options, MeshReport& report) {
  const bool turned = options.space == OutputSpace::kLps || options.space == OutputSpace::kRas;
  if (!turned || volume.geometry.space != Space::kUnknown) return;
  report.warnings.push_back(volume.path + ": the file does not say which space it is in; coordinates are kept");
}

void warn_of_rounding(const VolumeInfo& volume, const MeshOptions& options, const std::array<double, 3>& offset,
                      MeshReport& report) {
  const bool has_offset = offset != std::array<double, 3>{0, 0, 0};
  const double moved = rounding_of_places(volume, options.space, has_offset);
  if (!(has_offset || mesh_offset(volume, options.space) != offset) || !(moved > most_rounding(volume))) return;
  std::ostringstream text;
  text.precision(3);
  text << volume.path << ": lies so far from the origin that coordinates of " << (has_offset ? 64 : 32)
       << " bits move vertices by up to " << moved;
  if (!has_offset) text << ", as the sink was opened without the offset of the volume";
  report.warnings.push_back(text.str());
}

std::array<double, 3> common_offset(std::span<MeshSink* const> sinks) {
  for (const MeshSink* sink : sinks) {
    if (sink->offset() != sinks.front()->offset()) {
      throw std::invalid_argument("sinks: expected the same offset of all, found several");
    }
  }
  return sinks.empty() ? std::array<double, 3>{0, 0, 0} : sinks.front()->offset();
}

VertexExtras vertex_extras(const MeshOptions& options) {
  VertexExtras extras;
  if (options.normals != Normals::kAbsent) extras.extracted += sizeof(Point);
  if (options.values != nullptr) extras.extracted += sizeof(float);
  extras.held = extras.extracted + (options.normals == Normals::kQuadric ? sizeof(NormalQuadric) : 0);
  if (options.values != nullptr) extras.slice_bytes = options.values->info().slice_bytes();
  return extras;
}

void check_stop(const RunControl& control) {
  if (control.stop != nullptr && control.stop->load()) throw Interrupted("interrupted, nothing was written");
}

void report_simplifier(const Simplifier& simplifier, MeshReport& report) {
  const DecisionCounts counts = simplifier.counts();
  report.collapses = counts.collapses;
  report.postponed = counts.postponed;
  report.rekeyed = counts.rekeyed;
  report.specks = counts.specks;
  report.rounds = simplifier.rounds();
  report_defects(simplifier.defects(), report);
}

void report_defects(const SurfaceDefects& defects, SurfaceReport& report) {
  report.nonmanifold_edges = defects.nonmanifold_edges;
  report.nonmanifold_vertices = defects.nonmanifold_vertices;
}

std::vector<double> level_errors(std::span<const Length> levels, double error, double voxel, std::uint64_t triangles) {
  std::vector<double> errors;
  if (!levels.empty() && triangles > 0) {
    throw std::invalid_argument("levels: expected errors alone, found a number of triangles as well");
  }
  for (const Length& level : levels) {
    const double length = level.value * (level.voxels ? voxel : 1);
    if (!(length >= 0 && length < error && (errors.empty() || length > errors.back()))) {
      throw std::invalid_argument("levels: expected ascending errors of 0 or more and below " + std::to_string(error) +
                                  ", found " + std::to_string(length));
    }
    errors.push_back(length);
  }
  return errors;
}

double most_distance(const Length& length, double voxel) {
  const double distance = length.value * (length.voxels ? voxel : 1);
  if (distance >= 0 && std::isfinite(distance)) return distance;
  throw std::invalid_argument("max distance: expected a length of 0 or more, found " + std::to_string(distance));
}

void refuse_components(const std::string& path) {
  throw BadInput(path + ": the volume has changed: expected the surface that components were chosen in, found another");
}

void require_different(std::span<MeshSink* const> sinks) {
  std::set<const MeshSink*> seen;
  for (const MeshSink* sink : sinks) {
    if (sink == nullptr) throw std::invalid_argument("expected a sink for each mesh, found none");
    if (!seen.insert(sink).second) throw std::invalid_argument("expected a sink for each mesh, found one for two");
  }
}

void check_sinks(std::span<MeshSink* const> sinks, std::size_t levels) {
  if (sinks.size() != levels + 1) {
    throw std::invalid_argument("levels: expected " + std::to_string(levels + 1) + " sinks, found " +
                                std::to_string(sinks.size()));
  }
  require_different(sinks);
}

std::vector<CostBits> level_costs(std::span<const double> errors, double a0) {
  std::vector<CostBits> costs;
  for (const double error : errors) costs.push_back(retire_cost(error, a0));
  return costs;
}

}  // namespace isoweave
