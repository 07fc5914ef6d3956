#include "pipeline/label_sweep.hpp"

#include <algorithm>

#include "pipeline/slab_plan.hpp"
#include "pipeline/sweep.hpp"
#include "volume/labels.hpp"

namespace isoweave {
namespace {

// The mask has values 0 and 1, whatever the volume's surface was to be.
MeshOptions mask_options(const MeshOptions& options) {
  MeshOptions mask = options;
  mask.iso = 0.5;
  mask.inside_above = true;
  return mask;
}

HostSlabs::Options label_options(const SliceWindow& map, const Region& box, const IsoRule& rule,
                                 const MeshOptions& options, const RunControl& control) {
  HostSlabs::Options host = host_options(map.info(), rule, options, control);
  host.extract.part_of = {map.info().dims, box.first};
  return host;
}

}  // namespace

LabelBox::LabelBox(const SliceWindow& map, const Region& box, Label label)
    : map_(map), box_(box), label_(label), info_(map.info()) {
  info_.type = SampleType::kUint8;
  for (std::size_t axis = 0; axis < 3; ++axis) info_.dims[axis] = box.end[axis] - box.first[axis];
}

void LabelBox::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  const VolumeInfo& map = map_.info();
  const std::int64_t bytes = static_cast<std::int64_t>(sample_bytes(map.type));
  auto* mask = reinterpret_cast<std::uint8_t*>(out.data());
  for (std::int64_t k = first; k < first + count; ++k) {
    const std::byte* const slice = map_.slice(box_.first[2] + k);
    for (std::int64_t j = box_.first[1]; j < box_.end[1]; ++j, mask += info_.dims[0]) {
      mask_row(slice + (j * map.dims[0] + box_.first[0]) * bytes, map.type, info_.dims[0], label_, mask);
    }
  }
}

// A layer needs the slice above it and, for normals, one more; smoothing two for each pass.
std::int64_t slices_kept(const MeshOptions& options) { return 2 + 2 * static_cast<std::int64_t>(options.smooth); }

Region box_to_sweep(const Region& box, const VolumeInfo& volume, const MeshOptions& options) {
  // Crossings lie beside an inside sample; gradients look one sample further, smoothing two for each pass.
  const std::int64_t margin = 2 + 2 * static_cast<std::int64_t>(std::max(options.smooth, 0));
  Region swept;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    swept.first[axis] = std::max<std::int64_t>(box.first[axis] - margin, 0);
    swept.end[axis] = std::min(box.end[axis] + margin, volume.dims[axis]);
  }
  return swept;
}

LabelSweep::LabelSweep(const SliceWindow& map, const Region& box, const LabelSink& label, const MeshOptions& options,
                       const RunControl& control, const Executor& executor)
    : options_(options),
      most_vertices_(options.slab > 0 ? ~std::uint64_t{0} : slab_goal(simplifies(map.info(), options)).most_vertices),
      executor_(executor),
      box_(map, box, label.label),
      field_(box_, mask_options(options), executor_, false),
      world_(map.info().geometry, options.space, label.sink->offset()),
      sink_(label.sink),
      engine_(field_.info(), label_options(map, box, field_.rule(), options, control), world_, std::span(&sink_, 1),
              executor_, control.stop),
      window_(field_.source(), 0, SliceWindow::Reading::kInPlace) {
  report_.error = length_in(map.info(), options.error);
}

void LabelSweep::sweep_below(std::int64_t end) {
  const std::int64_t slices = field_.info().dims[2];
  const std::int64_t there = field_.slices_from(std::min(end - box_.first_slice(), slices));
  while (engine_.layers_left() > 0) {
    const std::int64_t layers = there == slices ? engine_.layers_left() : there - engine_.slices_for(0).second;
    if (layers < 1) return;
    sweep_slab(options_.slab > 0 ? std::min(layers, options_.slab) : layers);
  }
}

void LabelSweep::sweep_slab(std::int64_t layers) {
  Stopwatch clock;
  const auto [first, end] = engine_.slices_for(layers);
  window_.advance(first, end);
  clock.lap(report_.seconds_read);
  engine_.extract(window_, layers, most_vertices_, report_);
  clock.lap(report_.seconds_extract);
  record_ = {};
  record_.bytes = window_.bytes();
  engine_.simplify(record_);
  clock.lap(report_.seconds_simplify);
  engine_.write(record_, report_);
  clock.lap(report_.seconds_write);
  record_.final_triangles = report_.triangles;
}

MeshReport LabelSweep::finish() {
  engine_.wait_for_sink();
  engine_.finish(report_);
  return std::move(report_);
}

}  // namespace isoweave
