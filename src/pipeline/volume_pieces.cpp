#include "pipeline/volume_pieces.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "extract/values.hpp"
#include "files/atomic_file.hpp"
#include "isoweave/error.hpp"
#include "pipeline/cap_samples.hpp"
#include "pipeline/run_report.hpp"

namespace isoweave {

VolumePieces::VolumePieces(const Task& task, SurfaceField& field, Extractor& extractor, SlabPlanner& planner,
                           const Executor& executor)
    : task_(task), field_(field), extractor_(extractor), planner_(planner), executor_(executor) {}

void VolumePieces::open() {
  const std::int64_t first = extractor_.slices_for(1).first;
  const SliceWindow::Reading reading = SliceWindow::reading_with(executor_.threads());
  window_.emplace(field_.source(), first, reading);
  read_.caps = caps_;
  if (task_.attributes.values != nullptr) values_window_.emplace(*task_.attributes.values, first, reading);
}

void VolumePieces::read(const Held& held, MeshReport& report) {
  Stopwatch clock;
  failed_reading_ = true;
  plan_ = planner_.next(held, window_->room());
  read_slices();
  failed_reading_ = false;
  clock.lap(report.seconds_read);
  if (extractor_.takes_slices_early()) extractor_.take_slices(*window_, plan_.layers);
}

void VolumePieces::read_slices() {
  const auto [first, end] = extractor_.slices_for(plan_.layers);
  const std::int64_t read = window_->advance(first, end, plan_.ahead);
  if (values_window_) values_window_->advance(first, end, plan_.ahead);
  check_expected();
  read_.voxels += static_cast<std::uint64_t>(read * task_.volume.slice_samples());
  if (task_.measured) measure_samples(read);
  if (task_.measured && counts_caps_) measure_caps(read);
}

void VolumePieces::expect_next_slice(std::uint32_t crc, const std::string& state) {
  expected_crc_ = crc;
  state_ = state;
}

void VolumePieces::check_expected() {
  const bool same = !expected_crc_ || expected_crc_ == crc_of_next_slice();
  expected_crc_.reset();
  if (same) return;
  throw BadInput(task_.volume.path + ": the volume has changed: expected the samples that " + state_ +
                 " was saved with, found others");
}

void VolumePieces::make(SurfacePiece& piece, MeshReport& report) {
  Stopwatch clock;
  const SlabCounts slab = extractor_.extract(*window_, plan_.layers, plan_.most_vertices, piece);
  planner_.note_extracted(slab);
  range_.merge(read_.range);
  caps_ = read_.caps;
  voxels_ += std::exchange(read_, {{}, 0, caps_}).voxels;
  add_extracted(slab, report);
  if (values_window_) {
    sample_values(*values_window_, extractor_.numbering(), field_.info().geometry.spacing, executor_, piece);
  }
  clock.lap(report.seconds_extract);
}

std::uint64_t VolumePieces::bytes() const { return window_->bytes() + (values_window_ ? values_window_->bytes() : 0); }

// Finds the range of the slices just read, the last ones in the window.
void VolumePieces::measure_samples(std::int64_t slices) {
  const VolumeInfo& volume = task_.volume;
  std::vector<SampleRange> ranges(static_cast<std::size_t>(slices));
  executor_.for_each(slices, 1, [&](std::int64_t n) {
    const std::int64_t k = window_->end() - slices + n;
    const SampleRange* const known = field_.range(k);
    ranges[static_cast<std::size_t>(n)] =
        known != nullptr ? *known : sample_range(window_->slice(k), volume.type, volume.slice_samples());
  });
  for (const SampleRange& range : ranges) read_.range.merge(range);
}

// Counts the samples on caps in the slices just read.
void VolumePieces::measure_caps(std::int64_t slices) {
  CapSamples& caps = read_.caps;
  for (std::int64_t k = std::max(window_->end() - slices, caps.end); k < window_->end(); ++k) {
    caps.samples += count_cap_samples(window_->slice(k), k, field_.info(), field_.rule());
  }
  caps.end = window_->end();
}

std::optional<std::uint32_t> VolumePieces::crc_of_next_slice() const {
  const std::int64_t k = std::max<std::int64_t>(extractor_.slices_for(1).first, 0);
  if (!window_ || k >= window_->end()) return std::nullopt;
  if (const std::optional<std::uint32_t> known = field_.crc(k)) return known;
  return add_to_crc(0, {window_->slice(k), field_.info().slice_bytes()});
}

}  // namespace isoweave
