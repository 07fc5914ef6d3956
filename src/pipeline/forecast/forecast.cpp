// Forecasts: a few blocks of the volume are meshed, and the rest is assumed to be like them.
#include "isoweave/forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "extract/cube_rules.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/parallel.hpp"
#include "parallel/size.hpp"
#include "pipeline/forecast/forecast_curve.hpp"
#include "pipeline/forecast/forecast_depth.hpp"
#include "pipeline/forecast/forecast_profile.hpp"
#include "pipeline/forecast/forecast_sinks.hpp"
#include "pipeline/forecast/forecast_tile.hpp"
#include "pipeline/forecast/tile_run.hpp"
#include "pipeline/memory_cap.hpp"
#include "pipeline/memory_model.hpp"
#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/surface_field.hpp"
#include "pipeline/task.hpp"
#include "simplify/count_target.hpp"
#include "system/process_memory.hpp"
#include "volume/axes.hpp"
#include "volume/indexed_source.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// Thin blocks show how many triangles there are, thick blocks how many of them simplification leaves.
constexpr std::int64_t kThin = 2;  // slices
constexpr std::int64_t kThick = 15;
constexpr std::int64_t kThickBlocks = 3;
constexpr std::int64_t kMostBlocks = 24;
constexpr double kSampledPart = 0.04;  // of the volume's bytes
constexpr double kLeastBytes = 32e6;
constexpr double kMostBytes = 256e6;
constexpr std::size_t kTiles = 4;    // of a block that are simplified
constexpr double kTiledPart = 0.02;  // of the triangles, in tiles; twice that, where tiles are larger than small ones
constexpr double kSmallTile = 1000;  // triangles
constexpr double kLeastTile = 3000;  // where the surface is large enough
constexpr double kMostTile = 25000;
constexpr double kTileBytes = 16e6;
constexpr std::uint64_t kStreamBytes = std::uint64_t{512} << 20;
constexpr double kBandBytes = 64e6;  // of what meshing a block holds, whatever the cap: it must not be another forecast
constexpr std::int64_t kThinnestBand = 8;  // rows
constexpr double kRoughSurface = 250;      // triangles that are held, per sample along two sides of a slice
constexpr double kCapsLeft = 0.005;        // share of the triangles of caps that their outlines keep
constexpr double kCapMargin = 1.15;        // of the least cap, as the zone is a guess
constexpr double kCountMargin = 2.5;       // the same, where what is held depends on a number of triangles
constexpr double kHeldOfLeft = 3;          // held while a number of triangles is out of reach, of what will be left
constexpr double kLeftByCounting = 0.6;    // triangles that a sweep leaves which counts, of the number
constexpr double kCountedMargin = 1.4;     // of the least cap of such a sweep
constexpr double kThickSlabs = 0.45;       // time per triangle in slabs as they are chosen, in terms of that in a tile
constexpr double kUsualError = 0.3;        // mean voxels

// How a number of triangles is met: in one sweep, or not at all as too many triangles stay, or in a second sweep after
// one that counts.
enum class Meets : std::uint8_t { kAtOnce, kNever, kCounted };

struct BlockFacts {
  double per_layer = 0;  // triangles of the open surface
  double caps = 0;       // triangles per layer on the four sides of a closed one
};

class Forecaster {
 public:
  Forecaster(SliceSource& volume, const MeshOptions& options, const RunControl& control)
      : indexed_(indexed(volume, control.index, options, options.normals != Normals::kAbsent)),
        volume_(indexed_ ? *indexed_ : volume),
        rows_(volume_),
        info_(checked_volume(volume.info(), options.extractor)),
        options_(options),
        asked_(control) {
    if (control.index) bricks_.emplace(*control.index, stored_rule(info_, options));
    control_.threads = control.threads;
    control_.measure = false;
    control_.slab = control.slab;
    control_.stop = control.stop;
    may_count_ = can_repeat(volume, options, control);
    wanted_ = goal_of(options).triangles;
    error_ = error_of(options, mean_voxel(info_.geometry));
    // Tiles show how long simplification takes and how many triangles are left, at least where a number is to stop it.
    tile_error_ = std::isinf(error_) ? kUsualError * mean_voxel(info_.geometry) : error_;
    curve_.emplace(mean_voxel(info_.geometry), tile_error_);
    refuse_reader(control.memory);
    band_rows_ = band_rows();
    plan_blocks();
  }

  Forecast run() {
    if (constant_sample(volume_)) return conclude_constant();
    for (std::int64_t n = 0; n < blocks_; ++n) {
      const std::int64_t begin = slices_ * n / blocks_;
      const std::int64_t room = slices_ * (n + 1) / blocks_ - begin;
      const std::int64_t thick = n % every_ == every_ / 2 ? thick_ : 0;
      const std::int64_t thin = thick == 0 || room >= thick + kThin ? std::min(kThin, room) : 0;
      const std::int64_t first = begin + (room - thin - thick) / 2;
      band_ = band_of(n);
      map_ = TriangleMap({info_.dims[0], band_.count, info_.dims[2]});
      if (n == 0 && first > 0 && options_.closed) first_cap_ = end_cap(0);
      BlockFacts facts;
      if (thin > 0) facts = look_and_map(first, thin);
      if (thick > 0) facts = look_at_thick(first + thin, thick, facts.per_layer);
      facts_.push_back(facts);
    }
    if (options_.closed && !last_cap_) last_cap_ = volume_.skips() ? end_cap(info_.dims[2] - 1) : first_cap_;
    left_ = curve_->share_left();
    return conclude();
  }

 private:
  // The bytes that meshing a block of slices holds, per sample of a slice: slices in the ring, and bits.
  double block_bytes() const { return 9 * static_cast<double>(sample_bytes(info_.type)) + 4; }

  // Refuses a source that decodes more at once than the cap leaves, unless that is no more than looking at a volume
  // takes anyway. Such a source is not read at all, so the surface is not known: the cap that is named is enough for a
  // rough one.
  void refuse_reader(std::uint64_t cap) const {
    const auto held = static_cast<double>(held_by_rows(volume_));
    const double least =
        static_cast<double>(resident_) + held + kThinnestBand * block_bytes() * static_cast<double>(info_.dims[0]);
    if (cap == 0 || held <= kBandBytes || least <= static_cast<double>(cap)) return;
    const Profiles rough{Profile({kRoughSurface * static_cast<double>(info_.dims[0] + info_.dims[1])}, 1),
                         Profile({0.0}, 1)};
    refuse_cap(info_.path, with_slack(to_count(std::max(least, least_cap(rough)))), cap);
  }

  // The rows of the bands that are looked at: all rows, unless slices are so large that a block of them would not fit.
  std::int64_t band_rows() const {
    const double rows = kBandBytes / (block_bytes() * static_cast<double>(info_.dims[0]));
    return std::clamp(static_cast<std::int64_t>(rows), std::min(kThinnestBand, info_.dims[1]), info_.dims[1]);
  }

  // The band of a block. Bands are spread evenly however many blocks there are (by the golden section), the first one
  // in the middle.
  RowBand band_of(std::int64_t block) const {
    const double place = 0.5 + 0.6180339887498949 * static_cast<double>(block);
    const auto free = static_cast<double>(info_.dims[1] - band_rows_);
    return {static_cast<std::int64_t>((place - std::floor(place)) * free), band_rows_};
  }

  // Plans the blocks: how many there are, one in each of as many equal parts, and how thick the thick ones are.
  // Together they are a small part of the volume.
  void plan_blocks() {
    const auto whole = static_cast<double>(info_.slice_bytes());
    const double slice = whole * static_cast<double>(band_rows_) / static_cast<double>(info_.dims[1]);
    slices_ = info_.dims[2];
    if (!volume_.skips()) {
      const auto most = static_cast<std::int64_t>(static_cast<double>(kStreamBytes) / whole);
      slices_ = std::clamp<std::int64_t>(most, std::min(band_rows_ < info_.dims[1] ? kThin : kThick, slices_), slices_);
    }
    const double budget =
        std::clamp(kSampledPart * slice * static_cast<double>(info_.dims[2]), kLeastBytes, kMostBytes);
    const auto affordable = static_cast<std::int64_t>(budget / slice);
    thick_ = std::min(kThick, slices_);
    const std::int64_t thick_blocks = affordable >= 2 * kThickBlocks * thick_ ? kThickBlocks : 1;
    blocks_ = std::clamp<std::int64_t>((affordable - thick_blocks * thick_) / kThin + thick_blocks, 1, kMostBlocks);
    blocks_ = std::clamp<std::int64_t>(slices_ / thick_, 1, blocks_);
    every_ = (blocks_ + thick_blocks - 1) / thick_blocks;
  }

  // The triangles of a cap for each inside sample under it: a quadrilateral, or around the four edges of tetrahedra
  // that lead out of the volume there twice as many triangles as vertices.
  double cap_triangles() const { return options_.extractor == ExtractorKind::kTetrahedra ? 8 : 2; }

  // The triangles on one side of a slice that no block looks at, where the slice is an end of a closed volume.
  double end_cap(std::int64_t k) {
    double cap = 0;
    const std::size_t row = info_.slice_bytes() / static_cast<std::size_t>(info_.dims[1]);
    std::vector<std::byte> band(to_size(band_rows_, row));
    for (std::int64_t j = 0; j < info_.dims[1]; j += band_rows_) {
      const std::int64_t rows = std::min(band_rows_, info_.dims[1] - j);
      rows_.read(k, j, rows, band);
      cap += cap_triangles() * inside_in(std::span(band).first(static_cast<std::size_t>(rows) * row));
    }
    return cap;
  }

  double inside_in(std::span<const std::byte> bytes) const {
    const IsoRule rule = stored_rule(info_, options_);
    return visit_sample_type(info_.type, [&]<class T>() {
      const std::span samples(reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T));
      const auto is_inside = [&](T sample) {
        const auto value = static_cast<double>(sample);
        return rule.above ? value >= rule.iso : value <= rule.iso;
      };
      return static_cast<double>(std::ranges::count_if(samples, is_inside));
    });
  }

  // Looks at a block, maps its triangles, and fills tiles of it.
  BlockFacts look_and_map(std::int64_t first, std::int64_t slices, std::span<Tile> tiles = {}) {
    const auto look = [&](double i, double j, double /*k*/) { map_.add(i, j); };
    LocatingSink sink(info_.geometry.spacing, look);
    return look_at(first, slices, sink, tiles);
  }

  // Looks at a block, and simplifies parts of it. per_layer: the triangles of the thin block before it, which has
  // mapped them; 0 if there is no such block.
  BlockFacts look_at_thick(std::int64_t first, std::int64_t slices, double per_layer) {
    CountingSink sink;
    if (error_ == 0) return look_at(first, slices, sink, {});
    std::vector<Tile> tiles;
    for (const Rectangle& part : parts(per_layer, slices)) tiles.emplace_back(info_, part, slices);
    const bool mapped = per_layer > 0;
    const BlockFacts facts = mapped ? look_at(first, slices, sink, tiles) : look_and_map(first, slices, tiles);
    if (!mapped && facts.per_layer > 0) {
      const Tile whole = std::move(tiles.front());
      tiles.clear();
      for (const Rectangle& part : parts(facts.per_layer, slices)) tiles.push_back(whole.cut(part));
    }
    if (facts.per_layer > 0) simplify(tiles);
    return facts;
  }

  // The parts of a block that are simplified; one around the middle where its triangles are not mapped.
  std::vector<Rectangle> parts(double per_layer, std::int64_t slices) const {
    const double bytes = static_cast<double>(slices) * static_cast<double>(info_.slice_bytes()) / rows_in_bands();
    const double expected = per_layer * static_cast<double>(info_.dims[2]);
    const double least =
        std::clamp(2 * kTiledPart * expected, kThickBlocks * kTiles * kSmallTile, kThickBlocks * kTiles * kLeastTile);
    const double wanted = std::max(kTiledPart * expected, least) / kThickBlocks;
    const double in_block = per_layer / layers_in_bands() * static_cast<double>(std::max<std::int64_t>(slices - 1, 1));
    return map_.parts(kTiles, std::min(wanted / kTiles, kMostTile) / std::max(in_block, 1.0), kTileBytes / bytes);
  }

  // Counts the triangles of some slices, and fills tiles of them.
  template <class Sink>
  BlockFacts look_at(std::int64_t first, std::int64_t slices, Sink& sink, std::span<Tile> tiles) {
    double inside = 0;
    Section section(rows_, info_, first, slices, band_, [&](std::int64_t n, std::span<const std::byte> slice) {
      for (Tile& tile : tiles) tile.take(n, slice);
      if (options_.closed) inside += inside_on_sides(slice, info_, stored_rule(info_, options_), band_.count);
      if (options_.closed && first + n == 0) first_cap_ = cap_triangles() * inside_in(slice) * rows_in_bands();
      if (options_.closed && first + n == info_.dims[2] - 1)
        last_cap_ = cap_triangles() * inside_in(slice) * rows_in_bands();
    });
    Stopwatch watch;
    const MeshReport report = mesh(section, sink, 0);
    watch.lap(seconds_extracting_);
    slices_read_ += static_cast<double>(slices) / rows_in_bands();
    return {static_cast<double>(report.triangles) / layers(section) * layers_in_bands(),
            cap_triangles() * inside / layers(section)};
  }

  // Simplifies the tiles of a block.
  void simplify(std::span<Tile> tiles) {
    double undecided = 0, all = 0;
    for (Tile& tile : tiles) {
      CountBetween full = middle_of(tile), left = full;
      all += static_cast<double>(mesh(tile, full, 0).triangles);
      Stopwatch watch;
      const TileRun run = simplify_tile(tile, left, tile_options(options_, tile_error_), tile_control(3));
      watch.lap(seconds_simplifying_);
      curve_->add(full.total, left.total, run.removed);
      std::uint64_t most = 0;
      for (const SlabRecord& record : run.report.sweep) most = std::max(most, record.undecided_triangles);
      undecided += static_cast<double>(most);
    }
    simplified_ += all;
    depth_ = std::max(depth_, undecided * static_cast<double>(thick_ - 1) / (all + 1));
  }

  // A counter for the middle third of the layers of a tile: ends hardly disturb it.
  CountBetween middle_of(const Tile& tile) const {
    const double third = layers(tile) / 3 * info_.geometry.spacing[2];
    return CountBetween({third, 2 * third});
  }

  // Meshes the open surface of a block, in samples.
  MeshReport mesh(SliceSource& block, MeshSink& sink, std::int64_t slab) const {
    return mesh_volume(block, sink, tile_options(options_, 0), tile_control(slab));
  }

  RunControl tile_control(std::int64_t slab) const {
    RunControl control = control_;
    control.slab = slab;
    return control;
  }

  // The rows of a slice, and the layers between them, over those of a band.
  double rows_in_bands() const { return static_cast<double>(info_.dims[1]) / static_cast<double>(band_rows_); }
  double layers_in_bands() const {
    const auto between = [](std::int64_t rows) { return static_cast<double>(std::max<std::int64_t>(rows - 1, 1)); };
    return between(info_.dims[1]) / between(band_rows_);
  }

  static double layers(const SliceSource& block) {
    return static_cast<double>(std::max<std::int64_t>(block.info().dims[2] - 1, 1));
  }

  Forecast conclude() {
    const Profiles profiles = make_profiles();
    const auto layers = static_cast<double>(info_.dims[2]);
    const double open = profiles.open.below(layers);
    const double caps = profiles.caps.below(layers) + first_cap_ + last_cap_.value_or(0);
    const double extracted = open + caps;
    Forecast forecast;
    forecast.triangles_extracted = to_count(extracted);
    wanted_ = expected_number(options_, forecast.triangles_extracted);
    const double left = std::isinf(error_) ? extracted : open * left_ + caps * (error_ > 0 ? kCapsLeft : 1);
    forecast.triangles = to_count(left);
    if (wanted_ > 0) {
      forecast.triangles = left_of_number(forecast);
      forecast.head_start = curve_->head_start(options_, wanted_, open, kCapsLeft * caps);
    }
    forecast.vertices = forecast.triangles / 2;
    const double at_once = least_cap(profiles);
    const double least = may_count_ ? std::min(at_once, least_cap(profiles, Meets::kCounted)) : at_once;
    const bool is_short = asked_.memory > 0 && static_cast<double>(asked_.memory) < at_once;
    const bool counted = may_count_ && (asked_.count_first || is_short);
    const Peak of_run = peak(profiles, control_.slab, counted ? Meets::kCounted : Meets::kAtOnce);
    forecast.peak_bytes = to_count(of_run.bytes);
    forecast.surface_bytes = to_count(of_run.surface);
    forecast.least_bytes = with_slack(to_count(least));
    forecast.least_bytes_at_once = may_count_ ? to_count(at_once) : 0;
    const double sweeps = counted ? 2 : 1;
    forecast.seconds = sweeps * seconds_extracting_ / slices_read_ * layers;
    if (simplified_ > 0) forecast.seconds += sweeps * kThickSlabs * seconds_simplifying_ / simplified_ * extracted;
    return forecast;
  }

  // The triangles that are left: a run stops at the number or at the error, whichever leaves more.
  std::uint64_t left_of_number(const Forecast& forecast) const {
    return std::min(std::isinf(error_) ? wanted_ : std::max(wanted_, forecast.triangles), forecast.triangles_extracted);
  }

  // The forecast of a closed volume that is inside as a whole: its surface is the six sides.
  Forecast conclude_constant() {
    const bool inside = is_inside(*constant_sample(volume_), info_.type, stored_rule(info_, options_));
    const auto sides = static_cast<double>(info_.dims[0] + info_.dims[1]);
    const bool boxed = inside && options_.closed;
    facts_.push_back({0, boxed ? 2 * cap_triangles() * sides : 0});
    first_cap_ = boxed ? cap_triangles() * static_cast<double>(info_.slice_samples()) : 0;
    last_cap_ = first_cap_;
    slices_read_ = 1;
    blocks_ = 1;
    return conclude();
  }

  Profiles make_profiles() const {
    std::vector<double> open;
    std::vector<double> caps;
    for (const BlockFacts& facts : facts_) {
      open.push_back(facts.per_layer);
      caps.push_back(facts.caps);
    }
    const double distance = static_cast<double>(slices_) / static_cast<double>(blocks_);
    Profile at_caps(std::move(caps), distance);
    if (bricks_) return {Profile(bricks_->spread(open, distance), static_cast<double>(kBrick)), std::move(at_caps)};
    return {Profile(std::move(open), distance), std::move(at_caps)};
  }

  // Whether the error or the topology leaves more triangles than the number that was asked for.
  bool is_out_of_reach(const Profiles& profiles) const {
    const double all = profiles.open.below(static_cast<double>(info_.dims[2]));
    return simplified_ > 0 && !std::isinf(error_) && left_ * all > static_cast<double>(wanted_);
  }

  // The undecided triangles when the slab at a layer is appended. Nothing is final until a number of triangles is met,
  // unless it was counted.
  double held_before(const Profiles& profiles, double at, double depth, Meets meets) const {
    if (wanted_ > 0 && meets != Meets::kCounted) {
      const double all = profiles.open.below(at) + profiles.caps.below(at);
      const auto most = static_cast<double>(CountTarget::most_held(wanted_));
      if (meets == Meets::kAtOnce) return std::min(all, most);
      return std::min(all, std::max(most, kHeldOfLeft * left_ * all));
    }
    const auto above = [&](const Profile& profile, double layers) {
      return profile.below(at) - profile.below(at - layers);
    };
    return above(profiles.open, depth) + kCapWeight * above(profiles.caps, kCapDepth * depth);
  }

  // The peak of a run's memory, and the part of it that another surface would take once more.
  struct Peak {
    double bytes = 0, surface = 0;
  };

  // The share of the triangles that is left where the zone is deepest.
  double least_share(const Profiles& profiles, Meets meets) const {
    const double all = profiles.open.below(static_cast<double>(info_.dims[2]));
    if (meets != Meets::kCounted || !(all > 0)) return left_;
    const double share = std::min(kLeftByCounting * static_cast<double>(wanted_) / all, 1.0);
    return std::isinf(error_) ? share : std::max(share, left_);
  }

  // The peak is found by going through the slabs of the run.
  Peak peak(const Profiles& profiles, std::int64_t asked, Meets meets = Meets::kAtOnce) const {
    const VolumeInfo field = SurfaceField::info_of(info_, options_);
    const MemoryModel model{resident_ + held_by_slices(volume_) + SurfaceField::memory(info_, options_),
                            field.slice_bytes(),
                            static_cast<std::uint64_t>(info_.slice_samples()),
                            Executor(control_.threads).threads(),
                            error_ > 0,
                            vertex_extras(options_),
                            options_.levels.size(),
                            options_.max_distance.value > 0};
    const double deeper = options_.quality == Quality::kFine ? kFineDepth : 1;
    const double depth =
        error_ == 0 || depth_ < kSeenDepth ? depth_ : deeper * undecided_layers(least_share(profiles, meets));
    const auto sum = [](const Profile& profile, double from, double to) {
      return profile.below(to) - profile.below(from);
    };
    Peak most{model.fixed(), 0};
    double ring = 0;
    std::int64_t recent = 0;
    double per_layer = 0;
    for (std::int64_t done = 0; done < info_.dims[2]; done += recent) {
      const auto at = static_cast<double>(done);
      const double undecided = held_before(profiles, at, depth, meets);
      const SlabGoal goal = beside_zone(slab_goal(error_ > 0), undecided);
      // The slab was planned before its slices were read, when nobody knew how full it is.
      const std::int64_t planned = std::min(next_slab(field, goal, asked, recent, per_layer), info_.dims[2] - done);
      const auto ahead =
          static_cast<double>(std::min(slices_ahead(field, goal, planned), info_.dims[2] - done - planned));
      ring = std::max(ring,
                      MemoryModel::ring_for(static_cast<double>(planned), ahead, options_.normals != Normals::kAbsent));
      recent = planned;
      const auto extracted = [&] {
        const double end = at + static_cast<double>(recent);
        return sum(profiles.open, at, end) + sum(profiles.caps, at, end) + (done == 0 ? first_cap_ : 0) +
               (done + recent == info_.dims[2] ? last_cap_.value_or(0) : 0);
      };
      const double fullest = 2 * static_cast<double>(goal.most_vertices);
      while (asked == 0 && recent > 1 && extracted() > fullest) --recent;
      const double triangles = extracted();
      const double bytes = model.peak(static_cast<double>(planned), ring, triangles, undecided);
      if (bytes > most.bytes) most = {bytes, bytes - model.peak(static_cast<double>(planned), ring, 0, 0)};
      per_layer = triangles / static_cast<double>(recent);
    }
    // A smoothed field is one surface's own, with the slices that come out of it.
    if (options_.smooth > 0) {
      most.surface = most.bytes - model.fixed() + static_cast<double>(SurfaceField::memory(info_, options_));
    }
    return most;
  }

  // The cap that a run should do with, without slack.
  double least_cap(const Profiles& profiles, Meets meets = Meets::kAtOnce) const {
    if (meets == Meets::kCounted) return kCountedMargin * peak(profiles, 1, meets).bytes / kUsedPart;
    if (wanted_ == 0) return kCapMargin * peak(profiles, 1).bytes / kUsedPart;
    const double usual = kCountMargin * peak(profiles, 1).bytes / kUsedPart;
    if (!is_out_of_reach(profiles)) return usual;
    return std::max(usual, peak(profiles, 1, Meets::kNever).bytes / kUsedPart);
  }

  static std::uint64_t to_count(double number) { return static_cast<std::uint64_t>(std::max(number, 0.0)); }

  const std::unique_ptr<IndexedSource> indexed_;  // the volume, where there is an index of it
  SliceSource& volume_;
  RowReader rows_;
  const VolumeInfo info_;
  const MeshOptions& options_;
  const RunControl& asked_;
  RunControl control_;  // of the blocks
  const std::uint64_t resident_ = system::resident_bytes();
  bool may_count_ = false;       // the number of triangles in a sweep of its own
  std::uint64_t wanted_ = 0;     // triangles to stop at; of a share, those that are expected
  double error_ = 0;             // length
  double tile_error_ = 0;        // of tiles
  std::int64_t slices_ = 0;      // that are looked at
  std::int64_t thick_ = 0;       // slices of a thick block
  std::int64_t band_rows_ = 1;   // of a slice, that are looked at
  RowBand band_;                 // of the block
  TriangleMap map_{info_.dims};  // of the last thin block
  std::int64_t blocks_ = 0;
  std::int64_t every_ = 1;  // so many blocks one is thick
  std::vector<BlockFacts> facts_;
  std::optional<BricksOfLayers> bricks_;  // of the whole volume
  double slices_read_ = 0;                // in all blocks
  double simplified_ = 0;                 // triangles of tiles
  std::optional<ForecastCurve> curve_;    // of those in the middle
  double first_cap_ = 0;                  // triangles below the first slice, two for each sample inside
  std::optional<double> last_cap_;        // above the last one
  double left_ = 1;                       // share of the triangles that is left
  double depth_ = 0;                      // layers seen undecided
  double seconds_extracting_ = 0, seconds_simplifying_ = 0;
};

}  // namespace

void require_memory_to_read(SliceSource& volume, const MeshOptions& options, const RunControl& control) {
  Forecaster(volume, options, control);
}

Forecast forecast_mesh(SliceSource& volume, const MeshOptions& options, const RunControl& control) {
  const StandardFloats floats;
  return Forecaster(volume, options, control).run();
}

}  // namespace isoweave
