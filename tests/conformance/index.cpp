// Runs with an index make the mesh and the report of runs without, whatever is left out.
// Threads: Indexed.CheckpointsGoWithIt
#include "isoweave/index.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <random>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/forecast.hpp"
#include "surfaces.hpp"
#include "volume/row_source.hpp"

namespace isoweave::testing::index_test {
namespace {

// A volume in chunks, of which those that are left out give wrong samples: it fails for a reader that needs one.
class ChunkedVolume final : public RowSource {
 public:
  ChunkedVolume(const GenerateOptions& options, std::int64_t chunk, bool has_chunks)
      : info_(generate_volume(options)->info()), chunk_(chunk), has_chunks_(has_chunks) {
    samples_.resize(info_.slice_bytes() * static_cast<std::size_t>(info_.dims[2]));
    generate_volume(options)->read(0, info_.dims[2], samples_);
  }

  // Makes some samples NaN.
  void spoil(std::uint32_t seed) {
    std::mt19937 random(seed);
    auto* const samples = reinterpret_cast<float*>(samples_.data());
    for (int n = 0; n < 9; ++n) samples[random() % (samples_.size() / sizeof(float))] = std::nanf("");
  }

  // Makes a surface between slices 16 and 17 alone: beside the bricks below, which it does not cross.
  void flatten() {
    auto* sample = reinterpret_cast<float*>(samples_.data());
    for (std::int64_t k = 0; k < info_.dims[2]; ++k) {
      for (std::int64_t j = 0; j < info_.dims[1]; ++j) {
        for (std::int64_t i = 0; i < info_.dims[0]; ++i) {
          const double wave = 0.3 * std::sin(0.7 * static_cast<double>(i)) * std::cos(0.9 * static_cast<double>(j));
          *sample++ = static_cast<float>(static_cast<double>(k * k) / 33 - 8.25 + wave);
        }
      }
    }
  }

  const VolumeInfo& info() const override { return info_; }
  Gaps* gaps() override { return has_chunks_ ? &gaps_ : nullptr; }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    const std::size_t slice = info_.slice_bytes();
    for (std::int64_t n = 0; n < count; ++n) {
      read_rows(first + n, 0, info_.dims[1], out.subspan(static_cast<std::size_t>(n) * slice));
    }
  }

  void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    const std::size_t sample = sample_bytes(info_.type);
    rows_ += count;
    for (std::int64_t j = first; j < first + count; ++j) {
      bool left_out = false;
      for (std::int64_t i = 0; i < info_.dims[0]; ++i) {
        const std::size_t at = static_cast<std::size_t>((k * info_.dims[1] + j) * info_.dims[0] + i) * sample;
        const std::size_t to = static_cast<std::size_t>((j - first) * info_.dims[0] + i) * sample;
        if (i % chunk_ == 0) left_out = gaps_.needed != nullptr && !gaps_.needed->any_in(chunk_at(i, j, k));
        for (std::size_t n = 0; n < sample; ++n) out[to + n] = left_out ? std::byte{0x5a} : samples_[at + n];
        left_out_ += left_out ? 1 : 0;
      }
    }
  }

  std::int64_t rows() const { return rows_; }          // that were read
  std::int64_t left_out() const { return left_out_; }  // samples

 private:
  Region chunk_at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    Region box;
    const std::array<std::int64_t, 3> at{i, j, k};
    for (std::size_t a = 0; a < 3; ++a) {
      box.first.at(a) = at.at(a) / chunk_ * chunk_;
      box.end.at(a) = std::min(box.first.at(a) + chunk_, info_.dims.at(a));
    }
    return box;
  }

  VolumeInfo info_;
  std::int64_t chunk_;
  bool has_chunks_;
  Gaps gaps_;
  std::vector<std::byte> samples_;
  std::int64_t rows_ = 0, left_out_ = 0;
};

void expect_same(const MeshReport& with, const MeshReport& plain) {
  EXPECT_EQ(digest_text(with.digest), digest_text(plain.digest));
  EXPECT_EQ(with.triangles, plain.triangles);
  EXPECT_EQ(with.min, plain.min);
  EXPECT_EQ(with.max, plain.max);
  EXPECT_EQ(with.nan, plain.nan);
  EXPECT_EQ(with.cells_crossed, plain.cells_crossed);
  EXPECT_EQ(with.vertices_extracted, plain.vertices_extracted);
  EXPECT_EQ(with.triangles_extracted, plain.triangles_extracted);
  EXPECT_EQ(with.components, plain.components);
  EXPECT_EQ(with.components_dropped, plain.components_dropped);
  EXPECT_EQ(with.warnings, plain.warnings);
  ASSERT_EQ(with.levels.size(), plain.levels.size());
  for (std::size_t n = 0; n < with.levels.size(); ++n) EXPECT_EQ(with.levels[n].digest, plain.levels[n].digest);
}

struct IndexedCase {
  GenerateOptions volume{"sphere", {70, 55, 61}};
  std::int64_t chunk = 0;  // 0: rows
  bool nan = false, flat = false;

  ChunkedVolume open() const {
    ChunkedVolume opened(volume, std::max<std::int64_t>(chunk, 1), chunk > 0);
    if (nan) opened.spoil(3);
    if (flat) opened.flatten();
    return opened;
  }

  SurfaceRun run(const MeshOptions& options, const RunControl& control, std::int64_t* left_out = nullptr) const {
    ChunkedVolume opened = open();
    MemorySink sink, coarser;
    MeshSink* const sinks[] = {&coarser, &sink};
    SurfaceRun result;
    result.report = mesh_volume(opened, std::span(sinks).last(options.levels.size() + 1), options, control);
    result.mesh = std::move(sink.mesh);
    if (left_out != nullptr) *left_out = opened.left_out() + info_rows(opened);
    return result;
  }

  // Rows that were not read.
  static std::int64_t info_rows(const ChunkedVolume& opened) {
    return opened.info().dims[1] * opened.info().dims[2] - opened.rows();
  }

  // Returns whether anything was left out.
  bool expect_same_mesh(const MeshOptions& options) const {
    SCOPED_TRACE(::testing::Message() << volume.kind << ' ' << sample_type_name(volume.type) << ", chunks of " << chunk
                                      << ", iso " << options.iso << (options.inside_above ? " above" : " below")
                                      << (options.closed ? " closed" : " open"));
    RunControl control;
    control.threads = 1;
    control.slab = 5;
    const SurfaceRun plain = run(options, control);
    ChunkedVolume indexed = open();
    control.index = build_index(indexed);
    std::int64_t left_out = 0;
    const SurfaceRun with = run(options, control, &left_out);
    expect_same(with.report, plain.report);
    EXPECT_EQ(riders_digest(with.mesh), riders_digest(plain.mesh));
    EXPECT_TRUE(with.report.left_out);
    return left_out > 0;
  }
};

MeshOptions options_at(double iso) {
  MeshOptions options;
  options.iso = iso;
  options.error = Length::voxels(0.3);
  return options;
}

TEST(Indexed, MeshesOfFormulasAreTheSame) {
  int left_out = 0;
  for (const std::int64_t chunk : {0, 7, 16}) {
    for (const SampleType type : {SampleType::kUint8, SampleType::kInt16, SampleType::kFloat64}) {
      for (const char* kind : {"sphere", "box"}) {
        const IndexedCase scene{{kind, {70, 55, 61}, type}, chunk};
        MeshOptions options = options_at(suggested_iso(kind, type));
        for (const bool closed : {true, false}) {
          options.closed = closed;
          options.inside_above = !(closed && chunk == 7);
          left_out += scene.expect_same_mesh(options) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(left_out, 12) << "of 36";
}

TEST(Indexed, NormalsAreTheSame) {
  int left_out = 0;
  for (const std::int64_t chunk : {1, 3, 17}) {
    for (const Normals normals : {Normals::kGradient, Normals::kQuadric}) {
      MeshOptions options = options_at(suggested_iso("sphere", SampleType::kFloat32));
      options.normals = normals;
      for (const bool closed : {true, false}) {
        options.closed = closed;
        left_out += IndexedCase{{"sphere", {70, 55, 61}}, chunk}.expect_same_mesh(options) ? 1 : 0;
        IndexedCase{{"gyroid", {50, 35, 41}}, chunk}.expect_same_mesh(options);
      }
    }
  }
  EXPECT_EQ(left_out, 12);
  MeshOptions options = options_at(0);
  options.normals = Normals::kGradient;
  options.closed = false;
  EXPECT_TRUE((IndexedCase{{"sphere", {40, 35, 60}}, 1, false, true}.expect_same_mesh(options)));
}

TEST(Indexed, AnyIsoValueWillDo) {
  for (const std::int64_t chunk : {0, 9}) {
    for (const double iso : {-1e30, -1.0, 0.0, 0.5, 1.0, 127.5, 254.9, 255.0, 256.0, 1e30}) {
      for (const bool above : {true, false}) {
        MeshOptions options = options_at(iso);
        options.inside_above = above;
        IndexedCase{{"sphere", {40, 35, 41}, SampleType::kUint8}, chunk}.expect_same_mesh(options);
      }
    }
  }
}

TEST(Indexed, NanIsOutside) {
  for (const std::int64_t chunk : {0, 5, 30}) {
    IndexedCase scene{{"sphere", {70, 55, 61}}, chunk};
    scene.nan = true;
    for (const double iso : {suggested_iso("sphere", SampleType::kFloat32), -1e9}) {
      MeshOptions options = options_at(iso);
      scene.expect_same_mesh(options);
      options.inside_above = false;
      options.normals = Normals::kGradient;
      scene.expect_same_mesh(options);
    }
  }
}

TEST(Indexed, SmoothingAndLevelsAreTheSame) {
  MeshOptions options = options_at(suggested_iso("sphere", SampleType::kUint8));
  options.smooth = 3;
  EXPECT_TRUE((IndexedCase{{"sphere", {70, 55, 61}, SampleType::kUint8}, 8}.expect_same_mesh(options)));
  options.smooth = 0;
  options.levels = {Length::voxels(0.1)};
  EXPECT_TRUE((IndexedCase{{"sphere", {70, 55, 61}, SampleType::kUint8}, 8}.expect_same_mesh(options)));
}

TEST(Indexed, ComponentsAreTheSame) {
  const IndexedCase scene{{"noise", {40, 40, 40}, SampleType::kUint8}, 4};
  const ComponentRule rule{0, true};
  MeshOptions options = options_at(225);
  ChunkedVolume first = scene.open(), second = scene.open(), third = scene.open();
  RunControl control;
  control.threads = 1;
  const ComponentChoice plain = choose_components(first, options, rule, control);
  control.index = build_index(second);
  const ComponentChoice with = choose_components(third, options, rule, control);
  EXPECT_EQ(with.seeds, plain.seeds);
  options.components = std::make_shared<ComponentChoice>(with);
  scene.expect_same_mesh(options);
}

TEST(Indexed, CheckpointsGoWithIt) {
  const IndexedCase scene{{"sphere", {70, 55, 61}}, 8};
  const MeshOptions options = options_at(suggested_iso("sphere", SampleType::kFloat32));
  ChunkedVolume indexed = scene.open();
  const auto index = build_index(indexed);
  const MeshReport plain = scene.run(options, {}).report;
  // The state is saved with the index and resumed without, or the other way.
  for (const bool saved_with : {true, false}) {
    for (const bool resumed_with : {true, false}) {
      const files::Folder folder;
      std::atomic<bool> stop = false;
      RunControl control;
      control.threads = 2;
      control.slab = 12;
      control.stop = borrow(stop);
      control.progress = [&](const Progress& progress) { stop = progress.layer >= 24; };
      control.checkpoint.folder = folder.path();
      if (saved_with) control.index = index;
      ChunkedVolume opened = scene.open(), again = scene.open();
      class Forgetful final : public MeshSink {
       public:
        void append(const MeshPiece&) override {}
        void finish() override {}
        std::string mark() override { return ""; }
      } sink;
      EXPECT_THROW(mesh_volume(opened, sink, options, control), Interrupted);
      stop = false;
      control.progress = {};
      control.index = resumed_with ? index : nullptr;
      control.resume = read_checkpoint(folder.path());
      expect_same(mesh_volume(again, sink, options, control), plain);
    }
  }
}

TEST(Indexed, AnIndexOfAnotherSizeIsRefused) {
  MemorySink sink;
  RunControl control;
  control.index = build_index(*generate_volume({"sphere", {20, 20, 20}}));
  EXPECT_THROW(mesh_volume(*generate_volume({"sphere", {20, 20, 21}}), sink, options_at(0), control),
               std::invalid_argument);
  EXPECT_THROW(
      mesh_volume(*generate_volume({"sphere", {20, 20, 20}, SampleType::kUint8}), sink, options_at(0), control),
      std::invalid_argument);
}

// A ball that no place of a forecast meets: most slices are empty.
TEST(Indexed, ForecastsSeeTheWholeVolume) {
  const std::array<std::int64_t, 3> dims{128, 128, 400};
  std::vector<float> samples(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  const auto at = [&](std::int64_t i, std::int64_t j, std::int64_t k) -> float& {
    return samples[static_cast<std::size_t>((k * dims[1] + j) * dims[0] + i)];
  };
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) {
        const auto square = [](std::int64_t x) { return static_cast<double>(x * x); };
        at(i, j, k) = static_cast<float>(45 - std::sqrt(square(i - 64) + square(j - 64) + square(k - 335)));
      }
    }
  }
  MemoryVolume whole(dims, samples), read(dims, samples), indexed(dims, samples), looked(dims, samples);
  const MeshOptions options = options_at(0);
  MemorySink sink;
  const auto actual = static_cast<double>(mesh_volume(whole, sink, options).triangles_extracted);
  const auto off = [&](const Forecast& forecast) {
    return std::abs(static_cast<double>(forecast.triangles_extracted) / actual - 1);
  };
  RunControl control;
  const double without = off(forecast_mesh(read, options, control));
  control.index = build_index(indexed);
  const double with = off(forecast_mesh(looked, options, control));
  EXPECT_LT(with, without);
  EXPECT_LT(with, 0.1);
}

}  // namespace
}  // namespace isoweave::testing::index_test
