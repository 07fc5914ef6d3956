#include "pipeline/task.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>
#include <stdexcept>
#include <utility>

#include "extract/make_extractor.hpp"
#include "files/header_text.hpp"
#include "isoweave/error.hpp"
#include "lattice/vertex_numbering.hpp"
#include "volume/axes.hpp"
#include "volume/crossed_bricks.hpp"
#include "volume/indexed_source.hpp"
#include "volume/samples.hpp"
#include "volume/threshold.hpp"

namespace isoweave {
namespace {

double length_in(const Length& length, double side) { return length.value * (length.in_voxels ? side : 1); }

constexpr double kFarError = 64;  // of a distance: hardly an edge that costs more stays within it

double most_distance(const Length& length, double side) {
  const double distance = length_in(length, side);
  if (distance >= 0 && std::isfinite(distance)) return distance;
  throw std::invalid_argument("max distance: expected a length of 0 or more, found " + rounded_text(distance));
}

std::vector<double> level_errors(const SimplifyOptions& options, double error, double side) {
  std::vector<double> errors;
  if (!options.levels.empty() && goal_of(options).given()) {
    throw std::invalid_argument("levels of detail: expected errors alone, found a number of triangles as well");
  }
  if (options.levels.size() > kMostLevels) {
    throw std::invalid_argument("levels of detail: expected at most " + std::to_string(kMostLevels) +
                                " finer ones, found " + std::to_string(options.levels.size()));
  }
  for (const Length& level : options.levels) {
    const double length = length_in(level, side);
    if (!(length >= 0 && length < error && (errors.empty() || length > errors.back()))) {
      throw std::invalid_argument("levels of detail: expected ascending errors of 0 or more and below " +
                                  rounded_text(error) + ", found " + rounded_text(length));
    }
    errors.push_back(length);
  }
  return errors;
}

SurfaceMeasure measure_of(const VolumeInfo& volume, ExtractorKind extractor) {
  const double voxel = mean_voxel(volume.geometry);
  const auto& spacing = volume.geometry.spacing;
  const Vec3 cell{spacing[0], spacing[1], spacing[2]};
  const Vec3 largest = cells_of_triangle(extractor) * cell;
  return {voxel * voxel, voxel, numbering_of(extractor, volume.dims), cell, largest, volume.geometry.unit};
}

// Whether the volume has cells. An open volume of one sample along an axis has crossings and no triangles; only the
// simplifier can take such a surface.
bool has_cells(const VolumeInfo& volume, const SurfaceOptions& surface) {
  return surface.closed || std::ranges::min(volume.dims) > 1;
}

std::string size_text(const VolumeInfo& volume) {
  return std::to_string(volume.dims[0]) + " x " + std::to_string(volume.dims[1]) + " x " +
         std::to_string(volume.dims[2]);
}

// Throws where the volume of values does not have a sample for every sample of the volume.
void check_values(const VolumeInfo& volume, const AttributeOptions& attributes) {
  if (attributes.values == nullptr) return;
  const VolumeInfo& values = attributes.values->info();
  if (values.dims == volume.dims) return;
  throw BadInput(values.path + ": expected " + size_text(volume) + " samples as in " + volume.path + ", found " +
                 size_text(values));
}

}  // namespace

TriangleGoal goal_of(const SimplifyOptions& options) {
  const double share = options.share;
  if (share != 0 && !(share > 0 && share <= 1)) {
    throw std::invalid_argument("share: expected a number above 0 and up to 1, found " + rounded_text(share));
  }
  if (share > 0 && options.triangles > 0) {
    throw std::invalid_argument("share: expected a run without a number of triangles, found " +
                                std::to_string(options.triangles));
  }
  return {options.triangles, share};
}

SimplifyTask resolve_simplification(const SimplifyOptions& options, const SurfaceMeasure& measure) {
  SimplifyTask task;
  task.side = measure.side;
  task.unit = measure.unit;
  task.error = error_of(options, measure.side);
  task.level_errors = level_errors(options, task.error, measure.side);
  task.goal = goal_of(options);
  task.zone = {measure.numbering,
               measure.a0,
               retire_cost(task.error, measure.a0, task.goal.given()),
               options.drop_specks,
               most_distance(options.max_distance, measure.side),
               measure.cell,
               measure.largest,
               false,
               options.quality};
  for (const double error : task.level_errors) task.level_costs.push_back(retire_cost(error, measure.a0));
  return task;
}

Task resolve(const VolumeInfo& volume, const MeshOptions& options, const RunControl& control,
             const std::array<double, 3>& offset, RunKind kind) {
  require_possible(kind, options, control);
  Task task;
  task.volume = checked_volume(volume, options.extractor);
  task.surface = static_cast<const SurfaceOptions&>(options);
  task.attributes = static_cast<const AttributeOptions&>(options);
  task.space = options.space;
  task.offset = offset;
  task.rule = stored_rule(volume, options);
  task.simplify = resolve_simplification(options, measure_of(volume, options.extractor));
  const bool is_cut = kind == RunKind::kBlocks;  // so that all of it goes through the simplifier
  task.simplify.needed = options.error.value > 0 || !has_cells(volume, options) || is_cut;
  task.simplify.zone.normals_count = options.normals == Normals::kQuadric;
  task.simplify.normals = task.has_normals();
  task.simplify.values = options.values != nullptr;
  task.measured = control.measure;
  check_values(volume, options);
  return task;
}

MeshOptions full_surface(const SurfaceOptions& surface) {
  MeshOptions full;
  static_cast<SurfaceOptions&>(full) = surface;
  full.error = Length::units(0);
  return full;
}

const VolumeInfo& checked_volume(const VolumeInfo& volume, ExtractorKind extractor) {
  require_usable(volume);
  const VertexNumbering numbering = numbering_of(extractor, volume.dims);
  if (!numbering.fits()) {
    const int most = 64 - static_cast<int>(std::bit_width(std::uint64_t{numbering.slots} * numbering.width));
    throw BadInput(volume.path + ": expected fewer than 2^" + std::to_string(most) + " samples, found " +
                   size_text(volume));
  }
  return volume;
}

IsoRule stored_rule(const VolumeInfo& volume, const SurfaceOptions& options) {
  if (!std::isfinite(options.iso)) throw std::invalid_argument("iso: expected a finite number");
  IsoRule rule;
  rule.iso = (options.iso - volume.intercept) / volume.slope;
  rule.above = options.inside_above == (volume.slope > 0);
  rule.closed = options.closed;
  return rule;
}

std::unique_ptr<IndexedSource> indexed(SliceSource& volume, std::shared_ptr<const VolumeIndex> index,
                                       const SurfaceOptions& surface, bool has_normals) {
  if (index == nullptr) return nullptr;
  // Gradients are differences of neighbours. Dual marching cubes place vertices by them.
  const std::int64_t margin = has_normals || surface.extractor == ExtractorKind::kDual ? 1 : 0;
  const IsoRule rule = stored_rule(volume.info(), surface);
  const std::array surfaces{IndexedSurface{rule.iso, rule.above, rule.closed, margin}};
  return std::make_unique<IndexedSource>(volume, std::move(index), surfaces);
}

bool is_inside(const SampleBytes& sample, SampleType type, const IsoRule& rule) {
  return visit_sample_type(type, [&]<class T>() {
    T stored{};
    std::memcpy(&stored, sample.data(), sizeof stored);
    const Threshold<T> threshold = threshold_for<T>(rule.iso, rule.above);
    return threshold.reachable && (rule.above ? stored >= threshold.value : stored <= threshold.value);
  });
}

double error_of(const SimplifyOptions& options, double side) {
  const double error = length_in(options.error, side);
  const double distance = most_distance(options.max_distance, side);
  return std::isinf(error) && error > 0 && distance > 0 && !goal_of(options).given() ? kFarError * distance : error;
}

CostBits retire_cost(double error, double a0, bool to_number) {
  if (std::isinf(error) && error > 0 && to_number) return kRetiredCost - 1;
  if (!(error >= 0) || std::isinf(error)) {
    throw std::invalid_argument("error: expected a length of 0 or more, found " + rounded_text(error));
  }
  // An edge whose key is not known yet has cost 0. It must stay live, also when nothing is simplified. The cost of a
  // huge error overflows: no error lets an edge live that is never to be decided.
  return error > 0 ? std::min(to_cost(error * error / a0), kRetiredCost - 1) : kUnknownCost;
}

bool can_repeat(const SliceSource& volume, const MeshOptions& options, const RunControl& control) {
  const bool has_values = options.values == nullptr || !options.values->held().empty();
  return goal_of(options).given() && has_values && (control.reopen || !volume.held().empty());
}

CostBits head_start_cost(double error, double a0) {
  if (!(error >= 0) || std::isinf(error)) {
    throw std::invalid_argument("head start: expected a length of 0 or more, found " + rounded_text(error));
  }
  return retire_cost(error, a0);
}

CostBits head_start_cost(double error, const VolumeInfo& volume) {
  const double voxel = mean_voxel(volume.geometry);
  return head_start_cost(error, voxel * voxel);
}

double head_start_within(CostBits cost, const VolumeInfo& volume) {
  if (cost < to_cost(0)) return 0;
  double error = mean_voxel(volume.geometry) * std::sqrt(static_cast<double>(cost_value(cost)));
  while (head_start_cost(error, volume) > cost) error *= 1 - 0x1p-24;
  return error;
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

std::array<double, 3> common_offset(std::span<MeshSink* const> sinks) {
  for (const MeshSink* sink : sinks) {
    if (sink->offset() != sinks.front()->offset()) {
      throw std::invalid_argument("sinks: expected the same offset of all, found several");
    }
  }
  return sinks.empty() ? std::array<double, 3>{0, 0, 0} : sinks.front()->offset();
}

}  // namespace isoweave
