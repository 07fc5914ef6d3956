#include "pipeline/run_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

#include "files/header_text.hpp"
#include "isoweave/error.hpp"
#include "output/world.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kLeastTriangles = 4;  // of a closed component

// The bounds within which a run to a number of triangles was to stay.
std::string bounds_text(const SimplifyTask& task, double most_error) {
  const auto length = [&](double number) { return rounded_text(number) + (task.unit.empty() ? "" : " ") + task.unit; };
  std::string text = std::isfinite(most_error) ? " within an error of " + length(most_error) : "";
  const double most_distance = task.zone.most_distance;
  if (most_distance > 0)
    text += (text.empty() ? " within a distance of " : " and a distance of ") + length(most_distance);
  return text;
}

// The reason why more triangles are left than the number at which the run was to stop.
std::string why_more_are_left(const MeshReport& report, const SimplifyTask& task, double most_error) {
  std::string held = "no other collapse" + bounds_text(task, most_error) + " keeps the topology and the sides of faces";
  const std::uint64_t least = kLeastTriangles * report.components;
  if (report.open_edges > 0 || least <= report.target) return held;
  const std::string kept = "each of " + std::to_string(report.components) + " components keeps " +
                           std::to_string(kLeastTriangles) + " at least, " + std::to_string(least) + " in all";
  return report.triangles > least ? kept + "; " + held : kept;
}

std::string range_text(const MeshReport& report) {
  return "the samples go from " + number_text(report.min) + " to " + number_text(report.max);
}

// The reason why a mesh has no triangles.
std::string why_empty(const Task& task, const MeshReport& report) {
  if (report.components_dropped > 0) {
    return "nothing is left: each of " + std::to_string(report.components_dropped) + " components has fewer than " +
           std::to_string(task.surface.components->rule.min_triangles) + " triangles";
  }
  if (report.specks > 0) return "nothing is left: each component has shrunk to a speck within the error";
  const std::string iso = ", iso is " + number_text(task.surface.iso);
  if (report.min > report.max) return "the surface is empty: no samples are numbers" + iso;
  return "the surface is empty: " + range_text(report) + iso;
}

}  // namespace

void report_errors(const SimplifyTask& task, MeshReport& report) {
  report.error = task.error;
  report.levels.resize(task.level_errors.size());
  for (std::size_t n = 0; n < task.level_errors.size(); ++n) report.levels[n].error = task.level_errors[n];
}

void report_no_triangles(const SimplifyTask& task, MeshReport& mesh) {
  mesh.error = task.goal.given() ? 0 : task.error;
  mesh.target = task.goal.of(0);
}

void report_target(const DecisionCounts& counts, const SimplifyTask& task, std::uint64_t number, MeshReport& report) {
  report.target = number;
  const double most_error = report.error;
  const auto dearest = static_cast<CostBits>(counts.dearest);
  // All costs up to the floor are the same.
  const bool none = dearest <= cost_bits(kCostFloor);
  report.error = none ? 0 : task.side * std::sqrt(static_cast<double>(cost_value(dearest)));
  if (report.triangles <= number) return;
  report.warnings.push_back(std::to_string(report.triangles) + " triangles are left, " + std::to_string(number) +
                            " were asked for: " + why_more_are_left(report, task, most_error));
}

void warn_of_space(const Task& task, MeshReport& report) {
  const bool turned = task.space == OutputSpace::kLps || task.space == OutputSpace::kRas;
  if (!turned || task.volume.geometry.space != Space::kUnknown) return;
  report.warnings.push_back(task.volume.path + ": the file does not say which space it is in; coordinates are kept");
}

void warn_of_rounding(const Task& task, MeshReport& report) {
  const VolumeInfo& volume = task.volume;
  const bool has_offset = task.offset != std::array<double, 3>{0, 0, 0};
  const double moved = rounding_of_places(volume, task.space, has_offset);
  if (!(has_offset || mesh_offset(volume, task.space) != task.offset) || !(moved > most_rounding(volume))) return;
  std::ostringstream text;
  text.precision(3);
  text << volume.path << ": lies so far from the origin that coordinates of " << (has_offset ? 64 : 32)
       << " bits move vertices by up to " << moved;
  if (!has_offset) text << ", as the sink was opened without the offset of the volume";
  report.warnings.push_back(text.str());
}

void warn_of_values(const Task& task, MeshReport& report) {
  if (task.attributes.values == nullptr) return;
  const VolumeInfo& values = task.attributes.values->info();
  const Geometry& a = values.geometry;
  const Geometry& b = task.volume.geometry;
  if (a.spacing == b.spacing && a.origin == b.origin && a.direction == b.direction) return;
  report.warnings.push_back(values.path + ": lies elsewhere than " + task.volume.path +
                            " by its spacing, origin or axes; sample by sample it is taken for the same place");
}

void report_samples(const VolumeInfo& volume, const SampleRange& range, MeshReport& report) {
  const double low = volume.slope * range.min + volume.intercept;
  const double high = volume.slope * range.max + volume.intercept;
  report.min = range.empty() ? range.min : std::min(low, high);
  report.max = range.empty() ? range.max : std::max(low, high);
  report.nan = range.nan;
  if (range.nan == 0) return;
  report.warnings.push_back(volume.path + ": " + std::to_string(range.nan) + " samples are NaN and count as outside");
}

SampleRange range_of_constant(const SampleBytes& sample, const VolumeInfo& volume) {
  SampleRange range = sample_range(sample.data(), volume.type, 1);
  range.nan *= static_cast<std::uint64_t>(volume.slice_samples() * volume.dims[2]);
  return range;
}

void warn_of_nothing(const Task& task, bool allow_empty, MeshReport& report) {
  if (report.triangles == 0) report_nothing(task.volume.path + ": " + why_empty(task, report), allow_empty, report);
}

void report_nothing(const std::string& reason, bool allow_empty, MeshReport& report) {
  if (!allow_empty) throw EmptySurface(reason);
  report.warnings.push_back(reason);
}

void warn_of_border(const Task& task, MeshReport& report) {
  const SurfaceOptions& surface = task.surface;
  const bool known = report.min <= report.max && report.nan == 0;
  const bool all_inside = surface.inside_above ? report.min >= surface.iso : report.max <= surface.iso;
  if (!surface.closed || !known || !all_inside || report.triangles == 0) return;
  report.warnings.push_back(task.volume.path + ": the surface is nothing but the border of the volume: " +
                            range_text(report) + " and are all inside, iso is " + number_text(surface.iso));
}

void add_extracted(const SlabCounts& slab, MeshReport& report) {
  report.cells_crossed += slab.cells_crossed;
  report.triangles_extracted += slab.triangles;
  report.vertices_extracted += slab.vertices;
}

void report_decisions(const DecisionCounts& counts, MeshReport& report) {
  report.collapses = counts.collapses;
  report.postponed = counts.postponed;
  report.rekeyed = counts.rekeyed;
  report.specks = counts.specks;
}

void report_simplifier(const Simplifier& simplifier, MeshReport& report) {
  report_decisions(simplifier.counts(), report);
  report.rounds = simplifier.rounds();
  report_defects(simplifier.defects(), report);
}

void report_defects(const SurfaceDefects& defects, SurfaceReport& report) {
  report.nonmanifold_edges = defects.nonmanifold_edges;
  report.nonmanifold_vertices = defects.nonmanifold_vertices;
}

}  // namespace isoweave
