#include "pipeline/slab_planner.hpp"

#include <algorithm>

#include "pipeline/memory_cap.hpp"
#include "pipeline/surface_field.hpp"
#include "system/process_memory.hpp"

namespace isoweave {

SlabPlanner::SlabPlanner(const Task& task, const RunControl& control, const VolumeInfo& field,
                         const Extractor& extractor, int threads, std::uint64_t reader_bytes)
    : task_(task),
      field_(field),
      extractor_(extractor),
      threads_(threads),
      on_device_(control.device == Device::kCuda),
      asked_(control.slab),
      cap_(control.memory),
      elsewhere_(control.memory_elsewhere),
      resident_(control.memory > 0 ? system::resident_bytes() : 0),
      reader_(reader_bytes),
      folder_(control.checkpoint.folder),
      layers_(extractor.layers_left()) {}

SlabPlan SlabPlanner::next(const Held& held, std::int64_t ring) const {
  const SlabGoal goal =
      beside_zone(slab_goal(task_.simplify.needed, on_device_), static_cast<double>(held.triangles - held.waiting));
  SlabPlan plan;
  plan.layers = std::min({next_slab(field_, goal, asked_, recent_layers_, per_layer()), extractor_.most_layers(),
                          extractor_.layers_left()});
  plan.ahead = slices_ahead(field_, goal, plan.layers);
  plan.most_vertices = asked_ > 0 ? ~std::uint64_t{0} : goal.most_vertices;
  plan.most_vertices = std::min(plan.most_vertices, extractor_.room_for_vertices(cap_));
  if (cap_ > 0) fit_into_cap(plan, held, static_cast<double>(ring));
  return plan;
}

void SlabPlanner::note_extracted(const SlabCounts& slab) {
  recent_layers_ = slab.layers;
  recent_triangles_ = slab.triangles;
}

// Compares the zone with the formula, a fit: surfaces with more vertices, or more kept beside triangles, take more. The
// zone has room for the most triangles that it has held, as it never shrinks. The larger it is, the more the comparison
// tells: small ones are rounded up to whole pages.
void SlabPlanner::weigh_zone(const SlabRecord& record, const Held& held) {
  constexpr std::uint64_t kEnough = 20'000;  // triangles; with fewer the fixed part weighs too much
  most_held_ = std::max(most_held_, record.live_triangles);
  if (cap_ == 0 || most_held_ < kEnough) return;
  const double expected = memory_model(held, 1).zone(static_cast<double>(most_held_));
  if (expected > 0) heavier_ = std::max(static_cast<double>(held.zone_bytes) / expected, 1.0);
}

void SlabPlanner::serialize(StateWriter& state) const {
  state.value(recent_layers_);
  state.value(recent_triangles_);
}

void SlabPlanner::serialize(StateReader& state) {
  state.value(recent_layers_);
  state.value(recent_triangles_);
  state.require(recent_layers_ >= 0 && recent_layers_ <= layers_, "a slab of the volume");
}

double SlabPlanner::per_layer() const {
  return static_cast<double>(recent_triangles_) / static_cast<double>(std::max<std::int64_t>(recent_layers_, 1));
}

MemoryModel SlabPlanner::memory_model(const Held& held, double heavier) const {
  return {resident_ + elsewhere_ + reader_ + SurfaceField::memory(task_.volume, task_.surface) + held.other_bytes,
          field_.slice_bytes(),
          static_cast<std::uint64_t>(task_.volume.slice_samples()),
          threads_,
          task_.simplify.needed,
          vertex_extras(task_.attributes),
          task_.simplify.level_errors.size(),
          task_.simplify.zone.most_distance > 0,
          heavier};
}

// Makes slabs thinner and reads fewer slices ahead until the slab fits into the cap.
void SlabPlanner::fit_into_cap(SlabPlan& plan, const Held& held, double ring) const {
  const MemoryModel model = memory_model(held, heavier_);
  while (plan.layers > 1 && (is_too_thick(plan) || room(model, kUsedPart, plan, held, ring) <
                                                       per_layer() * static_cast<double>(plan.layers))) {
    plan.layers = (plan.layers + 1) / 2;
    plan.ahead = std::min(plan.ahead, plan.layers);
  }
  // A single layer may take more of the cap than slabs are planned for, unless a run to a number of triangles holds
  // many.
  const bool careful = plan.layers > 1 || task_.simplify.goal.given();
  const double left = room(model, careful ? kUsedPart : kLastPart, plan, held, ring);
  if (left < per_layer() || left <= 0) refuse_layer(model, held, ring);
  plan.most_vertices = std::min(plan.most_vertices, static_cast<std::uint64_t>(left / 2));
}

// Whether a plan makes the ring too large: it never shrinks, and the memory is missing where triangles are many.
bool SlabPlanner::is_too_thick(const SlabPlan& plan) const {
  const auto more = static_cast<double>(plan.layers + plan.ahead - 2);  // slices
  return more * static_cast<double>(field_.slice_bytes()) > kRingPart * static_cast<double>(cap_);
}

// The number of triangles that a part of the cap has room for.
double SlabPlanner::room(const MemoryModel& model, double part, const SlabPlan& plan, const Held& held,
                         double ring) const {
  const auto layers = static_cast<double>(plan.layers);
  const double needed = MemoryModel::ring_for(layers, static_cast<double>(plan.ahead), task_.has_normals());
  return model.triangles_within(part * static_cast<double>(cap_), layers, std::max(needed, ring),
                                static_cast<double>(held.triangles));
}

void SlabPlanner::refuse_layer(const MemoryModel& model, const Held& held, double ring) const {
  const auto needed = static_cast<std::uint64_t>(model.peak(1, ring, per_layer(), static_cast<double>(held.triangles)) /
                                                 kUsedPart * kNamedMargin);
  const std::string where = task_.volume.path + ": layer " + std::to_string(layers_ - extractor_.layers_left() + 1) +
                            " of " + std::to_string(layers_);
  refuse_cap(where, needed, cap_, folder_.empty() ? "" : "; the run can be resumed from " + folder_);
}

}  // namespace isoweave
