// The one loop: read a slab, extract it, simplify what is safe, write what is final.
#include <algorithm>
#include <cmath>
#include <string>

#include "extract/marching_cubes.hpp"
#include "isoweave/error.hpp"
#include "isoweave/pipeline.hpp"
#include "pipeline/final_output.hpp"
#include "pipeline/full_output.hpp"
#include "pipeline/sweep.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// A slab of this many triangles keeps all threads busy and stays small beside what a scan needs elsewhere.
constexpr double kSlabTriangles = 160000;
constexpr std::int64_t kSlabBytes = std::int64_t{64} << 20;

// The surface in stored sample units; a negative slope turns inside and outside around.
IsoRule stored_rule(const VolumeInfo& volume, const MeshOptions& options) {
  if (!std::isfinite(options.iso)) throw std::invalid_argument("iso: expected a finite number");
  IsoRule rule;
  rule.iso = (options.iso - volume.intercept) / volume.slope;
  rule.above = options.inside_above == (volume.slope > 0);
  rule.closed = options.closed;
  return rule;
}

class VolumeSweep {
 public:
  VolumeSweep(SliceSource& source, MeshSink& sink, const MeshOptions& options, const RunControl& control)
      : volume_(checked(source.info())),
        options_(options),
        control_(control),
        executor_(control.threads),
        window_(source),
        extractor_(volume_, {stored_rule(volume_, options), options.normals}, executor_),
        voxel_(cube_root(volume_.geometry.spacing[0] * volume_.geometry.spacing[1] * volume_.geometry.spacing[2])),
        simplifier_(simplifier_options(), executor_, control.stop),
        world_(volume_.geometry, options.space),
        output_(world_, sink, executor_, control.measure),
        full_output_(world_, sink, executor_, control.measure),
        sink_(sink) {}

  MeshReport run() {
    Stopwatch total;
    start_report();
    layers_ = extractor_.layers_left();
    while (extractor_.layers_left() > 0) {
      check_stop(control_);
      sweep_slab(next_slab());
    }
    finish_report();
    Stopwatch finishing;
    sink_.finish();
    finishing.lap(report_.seconds_write);
    total.lap(report_.seconds_total);
    report_.peak_bytes = peak_process_bytes();
    return std::move(report_);
  }

 private:
  static const VolumeInfo& checked(const VolumeInfo& volume) {
    if (!Lattice::fits(volume.dims)) {
      throw BadInput(volume.path + ": expected fewer than 2^54 samples, found " + std::to_string(volume.dims[0]) +
                     " x " + std::to_string(volume.dims[1]) + " x " + std::to_string(volume.dims[2]));
    }
    return volume;
  }

  SimplifierOptions simplifier_options() const {
    const Lattice lattice{volume_.dims};
    const double a0 = voxel_ * voxel_;
    const double error = options_.error.value * (options_.error.voxels ? voxel_ : 1);
    SimplifierOptions out;
    out.zone = {{lattice.row(), lattice.plane()}, a0, retire_cost(error, a0)};
    out.quality = options_.quality;
    out.schedule = control_.schedule;
    return out;
  }

  void start_report() {
    report_.threads = executor_.threads();
    report_.slab = options_.slab;
    report_.schedule = simplifier_.schedule();
    report_.error = options_.error.value * (options_.error.voxels ? voxel_ : 1);
    const bool turned = options_.space == OutputSpace::kLps || options_.space == OutputSpace::kRas;
    simplifies_ = report_.error > 0 || !has_cells();
    if (turned && volume_.geometry.space == Space::kUnknown) {
      report_.warnings.push_back(volume_.path + ": the file does not say which space it is in; coordinates are kept");
    }
  }

  // An open volume of one sample along an axis has crossings and no triangles.
  bool has_cells() const { return options_.closed || std::ranges::min(volume_.dims) > 1; }

  // Layers of the next slab: as asked, or as many as hold kSlabTriangles going by what has been extracted so far.
  std::int64_t next_slab() const {
    const std::int64_t left = extractor_.layers_left();
    if (options_.slab > 0) return std::min(options_.slab, left);
    const std::int64_t done = layers_ - left;
    const auto bytes = static_cast<std::int64_t>(volume_.slice_bytes());
    std::int64_t layers = std::clamp(kSlabBytes / std::max<std::int64_t>(bytes, 1), std::int64_t{4}, std::int64_t{64});
    if (done > 0) {
      const double per_layer = static_cast<double>(recent_triangles_ + 1) / static_cast<double>(recent_layers_);
      layers = std::min(layers, static_cast<std::int64_t>(kSlabTriangles / per_layer) + 1);
    } else {
      layers = std::min<std::int64_t>(layers, 8);
    }
    return std::min(layers, left);
  }

  void sweep_slab(std::int64_t layers) {
    const auto [first, end] = extractor_.slices_for(layers);
    const std::int64_t read = window_.advance(first, end);
    voxels_ += static_cast<std::uint64_t>(read * volume_.slice_samples());
    if (control_.measure) measure_samples(read);
    clock_.lap(report_.seconds_read);

    extractor_.extract(window_, layers, piece_);
    recent_triangles_ = piece_.triangles.size();
    recent_layers_ = layers;
    report_.cells_crossed += piece_.cells_crossed;
    report_.triangles_extracted += piece_.triangles.size();
    report_.vertices_extracted += piece_.positions.size();
    clock_.lap(report_.seconds_extract);

    SlabRecord record;
    simplifies_ ? take_final(record) : take_all(record);
    clock_.lap(report_.seconds_write);
    record.layer = layers_ - extractor_.layers_left();
    record.final_triangles = report_.triangles;
    report_.sweep.push_back(record);
    if (control_.progress) {
      control_.progress({record.layer, layers_, voxels_, record.live_triangles, record.final_triangles, record.bytes});
    }
  }

  void take_final(SlabRecord& record) {
    simplifier_.append(piece_);
    record.live_triangles = simplifier_.live_triangles();
    record.bytes = simplifier_.zone().bytes() + window_.bytes();
    simplifier_.decide();
    clock_.lap(report_.seconds_simplify);
    output_.take(simplifier_);
    output_.report(report_);
    record.undecided_triangles = simplifier_.live_triangles();
  }

  void take_all(SlabRecord& record) {
    record.live_triangles = piece_.triangles.size();
    record.bytes = window_.bytes();
    full_output_.take(piece_);
    full_output_.report(report_);
  }

  // Range of the slices just read, the last ones in the window.
  void measure_samples(std::int64_t slices) {
    std::vector<SampleRange> ranges(static_cast<std::size_t>(slices));
    executor_.for_each(slices, 1, [&](std::int64_t n) {
      ranges[static_cast<std::size_t>(n)] =
          sample_range(window_.slice(window_.end() - slices + n), volume_.type, volume_.slice_samples());
    });
    for (const SampleRange& range : ranges) range_.merge(range);
  }

  void finish_report() {
    report_simplifier(simplifier_, report_);
    const double low = volume_.slope * range_.min + volume_.intercept;
    const double high = volume_.slope * range_.max + volume_.intercept;
    report_.min = volume_.slope > 0 || range_.empty() ? low : high;
    report_.max = volume_.slope > 0 || range_.empty() ? high : low;
    report_.nan = range_.nan;
    if (range_.nan > 0) {
      report_.warnings.push_back(volume_.path + ": " + std::to_string(range_.nan) +
                                 " samples are NaN and count as outside");
    }
    if (report_.triangles > 0) return;
    report_.warnings.push_back(
        volume_.path + ": the surface is empty: iso " + std::to_string(options_.iso) +
        (range_.empty() ? ", no samples are numbers"
                        : ", samples from " + std::to_string(report_.min) + " to " + std::to_string(report_.max)));
  }

  const VolumeInfo volume_;
  const MeshOptions& options_;
  const RunControl& control_;
  const Executor executor_;
  SliceWindow window_;
  MarchingCubes extractor_;
  double voxel_;  // mean side of a voxel
  Simplifier simplifier_;
  World world_;
  FinalOutput output_;
  FullOutput full_output_;
  bool simplifies_ = true;
  MeshSink& sink_;
  SurfacePiece piece_;
  SampleRange range_;
  MeshReport report_;
  Stopwatch clock_;
  std::int64_t layers_ = 0;
  std::int64_t recent_layers_ = 1;
  std::uint64_t recent_triangles_ = 0;
  std::uint64_t voxels_ = 0;
};

}  // namespace

MeshReport mesh_volume(SliceSource& volume, MeshSink& sink, const MeshOptions& options, const RunControl& control) {
  return VolumeSweep(volume, sink, options, control).run();
}

}  // namespace isoweave
