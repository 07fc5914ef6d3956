// Many labels in one sweep.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/labels_sweep.hpp"

namespace isoweave {

void add_layer(LabelsReport& report, LabelsReport&& layer) {
  MeshReport& total = report.total;
  SampleRange range{total.min, total.max, total.nan};
  range.merge({layer.total.min, layer.total.max, layer.total.nan});
  total.min = range.min;
  total.max = range.max;
  total.seconds_read += std::exchange(layer.total.seconds_read, 0);
  add_to(total, layer.total);
  total.seconds_total += layer.total.seconds_total;
  total.peak_bytes = std::max(total.peak_bytes, layer.total.peak_bytes);
  total.sweep.insert(total.sweep.end(), layer.total.sweep.begin(), layer.total.sweep.end());
  for (MeshReport& label : layer.labels) report.labels.push_back(std::move(label));
}

Task resolve_labels(SliceSource& map, const std::array<double, 3>& offset, const MeshOptions& options,
                    const RunControl& control) {
  return resolve(LabelNumbers(map).info(), mask_options(options), control, offset, RunKind::kLabels);
}

bool may_be_rounded(Label label) {
  constexpr std::uint64_t kLargestWhole = std::uint64_t{1} << 24;  // whole numbers up to it are float32, all of them
  return (label.is_negative() ? -label.bits() : label.bits()) > kLargestWhole;
}

void warn_of_floats(const VolumeInfo& map, bool may_be_rounded, MeshReport& report) {
  if (map.type != SampleType::kFloat32 || !may_be_rounded) return;
  report.warnings.insert(report.warnings.begin(),
                         map.path + ": labels beyond 2^24 in float32 may have been rounded: several may be one");
}

LabelsReport mesh_labels(SliceSource& volume, std::span<const LabelSink> labels, const MeshOptions& options,
                         const RunControl& control) {
  const StandardFloats floats;
  checked_volume(volume.info(), options.extractor);
  std::vector<MeshSink*> sinks;
  for (const LabelSink& label : labels) sinks.push_back(label.sink);
  require_different(sinks);
  const Task task = resolve_labels(volume, common_offset(sinks), options, control);
  LabelsReport report = LabelsSweep(volume, {0, 0, 0}, task, labels, control).run();
  const auto is_rounded = [](const LabelSink& label) { return may_be_rounded(label.label); };
  warn_of_floats(volume.info(), std::ranges::any_of(labels, is_rounded), report.total);
  for (const LabelSink& label : labels) label.sink->finish();
  return report;
}

}  // namespace isoweave
