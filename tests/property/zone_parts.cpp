// Parts of the undecided surface: the same whatever held it, taken in by any back end, refused when damaged.
// Threads: ZoneParts.GoFromAnyHolderToAnyOther
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "device/bulk_engine.hpp"
#include "device/simulated_device.hpp"
#include "extract/marching_cubes.hpp"
#include "files.hpp"
#include "fuzz/saved_runs.hpp"
#include "pipeline/device_back_end.hpp"
#include "pipeline/host_back_end.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::zone_parts_test {
namespace {

using testing::MemorySink;
using testing::SurfaceCase;

const SurfaceCase kSurface{{"noise", {20, 18, 30}, SampleType::kUint8, {1, 1, 1.5}, 3}, true, 0.4};

// One way to hold and decide a surface.
struct Holder {
  std::int64_t slab;
  int threads;
  Schedule schedule = Schedule::kLocal;
  bool on_device = false;
};

const std::vector<Holder> kHolders{{3, 1},
                                   {1, 2},
                                   {15, 3},
                                   {4, 2, Schedule::kRounds},
                                   {5, 1, Schedule::kQueue},
                                   {6, 2, Schedule::kRounds, true},
                                   {2, 1, Schedule::kRounds, true}};

// Extractor and back end of a run.
class Stretch {
 public:
  Stretch(const Holder& holder, const World& world, MeshSink& sink) : holder_(holder), executor_(holder.threads) {
    SimplifyTask task;
    task.zone = kSurface.zone();
    control_.schedule = holder.schedule;
    if (holder.on_device) {
      engine_ = std::make_unique<BulkEngine<HostDevice>>(
          HostDevice(executor_), BulkOptions{source_->info(), kSurface.rule(), false, task.zone});
      extractor_ = std::make_unique<DeviceExtractor>(*engine_);
      back_end_ = std::make_unique<DeviceBackEnd>(*engine_, task, world, sink, executor_, true);
    } else {
      extractor_ = std::make_unique<MarchingCubes>(source_->info(), ExtractOptions{kSurface.rule()}, executor_);
      MeshSink* const sinks[] = {&sink};
      back_end_ = std::make_unique<HostBackEnd>(task, world, sinks, executor_, control_, nullptr);
    }
  }

  // Goes on up to a layer, or to the end.
  void advance(std::int64_t end) {
    SliceWindow window(*source_, extractor_->slices_for(1).first);
    while (extractor_->layers_left() > 0 && layer() < end) {
      const std::int64_t layers = std::min({holder_.slab, extractor_->layers_left(), end - layer()});
      const auto [first, last] = extractor_->slices_for(layers);
      window.advance(first, last);
      extractor_->extract(window, layers, 1 << 30, piece_);
      SlabRecord record;
      back_end_->simplify(piece_, extractor_->layers_left() == 0, record);
      back_end_->write(piece_, record, report);
    }
    back_end_->wait_for_sinks();
  }

  void save(const std::string& path) const {
    StateWriter writer(path);
    extractor_->serialize(writer);
    back_end_->serialize(writer);
    writer.commit();
  }

  void load(const std::string& path) {
    StateReader reader(path);
    extractor_->serialize(reader);
    back_end_->serialize(reader);
    reader.require_end();
    EXPECT_EQ(extractor_->inherited(), back_end_->inherited());
  }

  std::int64_t layer() const { return extractor_->slices_for(1).first; }
  bool complete() const { return extractor_->layers_left() == 0; }

  MeshReport report;

 private:
  Holder holder_;
  Executor executor_;
  std::unique_ptr<SliceSource> source_ = generate_volume(kSurface.volume);
  RunControl control_;
  std::unique_ptr<DeviceEngine> engine_;
  std::unique_ptr<Extractor> extractor_;
  std::unique_ptr<BackEnd> back_end_;
  SurfacePiece piece_;
};

// Shows take() a simplifier that holds all of a surface up to a layer: output would number the vertices by slabs.
template <class Take>
void hold_up_to(std::int64_t end, const SurfaceCase& surface, const Holder& holder, const Take& take) {
  const Executor executor(holder.threads);
  const auto source = generate_volume(surface.volume);
  Simplifier simplifier({surface.zone(), holder.schedule}, executor, nullptr);
  MarchingCubes extractor(source->info(), ExtractOptions{surface.rule()}, executor);
  SliceWindow window(*source);
  SurfacePiece piece;
  for (std::int64_t layer = -1; layer < end; layer = extractor.slices_for(1).first) {
    const auto [first, last] = extractor.slices_for(std::min(holder.slab, end - layer));
    window.advance(first, last);
    extractor.extract(window, std::min(holder.slab, end - layer), ~std::uint64_t{0}, piece);
    simplifier.append(piece);
    simplifier.decide();
  }
  take(simplifier);
}

std::string part_at(const Holder& holder, std::int64_t end, const std::string& path) {
  hold_up_to(end, kSurface, holder, [&](Simplifier& simplifier) {
    StateWriter writer(path);
    simplifier.zone().serialize(writer);
    writer.commit();
  });
  return files::read_bytes(path);
}

TEST(ZoneParts, AreTheSameForAnySlabThreadsAndSchedule) {
  const files::Folder folder;
  const std::string expected = part_at(kHolders[0], 14, folder / "part");
  EXPECT_GT(expected.size(), 50'000u);
  for (const Holder& holder : kHolders) {
    if (holder.on_device) continue;
    EXPECT_EQ(part_at(holder, 14, folder / "part"), expected) << holder.slab;
  }
  EXPECT_NE(part_at(kHolders[0], 15, folder / "part"), expected);
}

// The corners of a face by their ids, with the bound at each.
using NamedBounds = std::array<std::pair<std::uint64_t, CornerBound>, 3>;

template <class Triangles, class Vertices>
std::multiset<NamedBounds> bounds_of(const Triangles& triangles, const Vertices& vertices) {
  std::multiset<NamedBounds> all;
  for (const Triangle& t : triangles) {
    if (t.sides[0].vertex == kNone) continue;
    NamedBounds face;
    for (std::size_t c = 0; c < 3; ++c) face[c] = {vertices[t.sides[c].vertex].id, t.bounds[c]};
    std::ranges::sort(face);
    all.insert(face);
  }
  return all;
}

// Where distances are bounded, each corner of a face has a bound.
TEST(ZoneParts, HaveTheSameBoundsForAnySlabThreadsAndSchedule) {
  for (const double distance : {0.2, 0.6}) {
    SurfaceCase surface = kSurface;
    surface.max_distance = distance;
    std::vector<std::byte> expected;
    for (const Holder& holder : kHolders) {
      if (holder.on_device) continue;
      hold_up_to(14, surface, holder, [&](Simplifier& simplifier) {
        const auto held = bounds_of(simplifier.zone().triangles, simplifier.zone().vertices);
        const auto is_bounded = [](const NamedBounds& face) { return face[0].second < kBoundUnits; };
        EXPECT_GT(std::ranges::count_if(held, is_bounded), 100);
        ZonePart part = simplifier.take_part([](std::uint64_t, std::uint64_t) { return false; });
        StateWriter writer;
        write_part(writer, part);
        const std::vector<std::byte> bytes = writer.take();
        if (expected.empty()) expected = bytes;
        EXPECT_TRUE(bytes == expected) << holder.slab;
        StateReader reader(bytes, "a part", "part");
        const PartShape shape{
            .retire = surface.zone().retire, .end_id = ~std::uint64_t{0}, .farthest = {99, 99, 99}, .ends = {{}}};
        const ZonePart found = read_cut_part(reader, shape);
        EXPECT_TRUE(std::ranges::includes(held, bounds_of(found.triangles, found.vertices))) << holder.slab;
      });
    }
  }
}

TEST(ZoneParts, GoFromAnyHolderToAnyOther) {
  MemorySink whole_sink;
  const World world;
  Stretch whole(kHolders[0], world, whole_sink);
  whole.advance(kSurface.volume.dims[2]);
  ASSERT_GT(whole.report.triangles, 1000u);
  const files::Folder folder;
  for (std::size_t first = 0; first < kHolders.size(); ++first) {
    MemorySink sink;
    auto stretch = std::make_unique<Stretch>(kHolders[first], world, sink);
    for (std::size_t n = first + 1;; ++n) {
      stretch->advance(stretch->layer() + 5);
      if (stretch->complete()) break;
      stretch->save(folder / "state");
      stretch = std::make_unique<Stretch>(kHolders[(3 * n) % kHolders.size()], world, sink);
      stretch->load(folder / "state");
    }
    EXPECT_EQ(stretch->report.digest, whole.report.digest) << first;
    EXPECT_EQ(stretch->report.components, whole.report.components);
    EXPECT_EQ(stretch->report.euler, whole.report.euler);
    EXPECT_EQ(stretch->report.open_edges, 0u);
    EXPECT_EQ(check_mesh(sink.mesh).digest, whole.report.digest);
  }
}

TEST(ZoneParts, AreWrittenAsTheyWereRead) {
  const files::Folder folder;
  const World world;
  MemorySink sink;
  Stretch stretch(kHolders[0], world, sink);
  stretch.advance(12);
  stretch.save(folder / "a");
  for (const Holder& holder : {kHolders[2], kHolders[5]}) {
    Stretch other(holder, world, sink);
    other.load(folder / "a");
    other.save(folder / "b");
    EXPECT_EQ(files::read_bytes(folder / "a"), files::read_bytes(folder / "b"));
  }
}

// Whatever one byte of a state says, the state is refused, or the run comes to its end.
TEST(ZoneParts, AWrongByteIsRefusedOrHarmless) {
  const files::Folder folder;
  std::size_t refused = 0;
  std::size_t changed = 0;
  for (std::size_t run = 0; run < fuzz::kSavedRuns; ++run) {
    const fuzz::SavedState saved = fuzz::save_run(run, folder / "");
    for (std::size_t at = 0; at < saved.body.size(); at += 61) {
      fuzz::SavedState damaged = saved;
      damaged.body[at] = static_cast<char>(damaged.body[at] ^ (at % 3 == 0 ? 0x80 : 0x05));
      fuzz::put_state(damaged, folder / "");
      ++changed;
      try {
        fuzz::run_saved(run, folder / "", true);
      } catch (const BadInput& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find("state"), std::string::npos) << error.what();
      } catch (const OverMemory&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(changed, 1000U);
  EXPECT_GT(refused, changed / 10);
}

}  // namespace
}  // namespace isoweave::testing::zone_parts_test
