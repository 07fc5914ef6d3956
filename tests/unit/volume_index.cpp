// Indices: the ranges of bricks beside a search through all samples, the file, and what it is refused for.
// Threads: none, an index is made and read by one
#include "volume/volume_index.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "index_helpers.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/index.hpp"
#include "volume/crossed_bricks.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing::volume_index_test {
namespace {

namespace fs = std::filesystem;

// A raw file of random samples, some of them NaN, of which few differ, so that many bricks lie on one side.
struct RandomFloats {
  std::array<std::int64_t, 3> dims;
  std::vector<float> samples;

  RandomFloats(const std::array<std::int64_t, 3>& size, std::uint32_t seed) : dims(size) {
    std::mt19937 random(seed);
    const std::array most{1.0F, 5.0F, 1.0F, std::numeric_limits<float>::quiet_NaN()};
    samples.assign(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]), most.at(seed % most.size()));
    for (std::size_t n = 0; n < 2 + samples.size() / 9000; ++n) {
      const std::size_t at = random() % samples.size();
      samples[at] = n % 4 == 3 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(random() % 9);
    }
  }

  VolumeInfo info() const {
    VolumeInfo info;
    info.path = "random";
    info.dims = dims;
    info.type = SampleType::kFloat32;
    return info;
  }

  float at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return samples[static_cast<std::size_t>((k * dims[1] + j) * dims[0] + i)];
  }

  std::shared_ptr<const VolumeIndex> index() const {
    return build_index(*volume_in_memory(info(), std::as_bytes(std::span(samples))));
  }

  template <class Visit>
  void visit(const Region& box, const Visit& look) const {
    std::array<std::int64_t, 3> first{}, end{};
    for (std::size_t a = 0; a < 3; ++a) first.at(a) = std::max<std::int64_t>(box.first.at(a), 0);
    for (std::size_t a = 0; a < 3; ++a) end.at(a) = std::min(box.end.at(a), dims.at(a));
    for (std::int64_t k = first[2]; k < end[2]; ++k) {
      for (std::int64_t j = first[1]; j < end[1]; ++j) {
        for (std::int64_t i = first[0]; i < end[0]; ++i) look(at(i, j, k));
      }
    }
  }
};

const std::vector<std::array<std::int64_t, 3>> kSizes{{1, 1, 1}, {2, 17, 18}, {16, 1, 33}, {40, 35, 50}, {49, 48, 17}};

TEST(Index, RangesOfBricksAreThoseOfTheirSamples) {
  for (const auto& dims : kSizes) {
    const RandomFloats volume(dims, 4);
    const auto index = volume.index();
    const BrickLevel& bricks = index->levels().front();
    for (std::int64_t k = 0; k < bricks.size[2]; ++k) {
      for (std::int64_t j = 0; j < bricks.size[1]; ++j) {
        for (std::int64_t i = 0; i < bricks.size[0]; ++i) {
          float low = std::numeric_limits<float>::infinity(), high = -low;
          bool nan = false;
          const Region box{{16 * i, 16 * j, 16 * k}, {16 * i + 17, 16 * j + 17, 16 * k + 17}};
          volume.visit(box, [&](float sample) {
            nan = nan || std::isnan(sample);
            if (!std::isnan(sample)) low = std::min(low, sample), high = std::max(high, sample);
          });
          const std::size_t at = bricks.at(i, j, k);
          EXPECT_EQ(reinterpret_cast<const float*>(bricks.low.data())[at], low);
          EXPECT_EQ(reinterpret_cast<const float*>(bricks.high.data())[at], high);
          EXPECT_EQ(bricks.nan[at] != 0, nan);
        }
      }
    }
    EXPECT_EQ(index->levels().back().count(), 1U);
  }
}

// Surfaces in a volume of random samples, sample by sample.
class Surfaces {
 public:
  Surfaces(const RandomFloats& volume, std::vector<IndexedSurface> surfaces)
      : volume_(volume), surfaces_(std::move(surfaces)) {}

  bool inside(const IndexedSurface& surface, const std::array<std::int64_t, 3>& at) const {
    if (!is_within(at)) return false;
    const float sample = volume_.at(at[0], at[1], at[2]);
    return surface.above ? sample >= surface.iso : sample <= surface.iso;
  }

  // Whether a sample may stand for the one at a place.
  bool may_stand_for(float sample, const std::array<std::int64_t, 3>& at) const {
    return std::ranges::all_of(surfaces_, [&](const IndexedSurface& surface) {
      return (surface.above ? sample >= surface.iso : sample <= surface.iso) == inside(surface, at);
    });
  }

  // Whether a place, or one within the margin, is an end of a crossed edge.
  bool need(const std::array<std::int64_t, 3>& at) const {
    return std::ranges::any_of(surfaces_, [&](const IndexedSurface& surface) {
      const std::int64_t m = surface.margin;
      for (std::int64_t z = -m; z <= m; ++z) {
        for (std::int64_t y = -m; y <= m; ++y) {
          for (std::int64_t x = -m; x <= m; ++x) {
            if (is_end(surface, {at[0] + x, at[1] + y, at[2] + z})) return true;
          }
        }
      }
      return false;
    });
  }

  const std::vector<IndexedSurface>& all() const { return surfaces_; }

 private:
  bool is_within(const std::array<std::int64_t, 3>& at) const {
    bool within = true;
    for (std::size_t a = 0; a < 3; ++a) within = within && at.at(a) >= 0 && at.at(a) < volume_.dims.at(a);
    return within;
  }

  bool is_end(const IndexedSurface& surface, const std::array<std::int64_t, 3>& at) const {
    if (!is_within(at)) return false;
    for (std::size_t a = 0; a < 3; ++a) {
      for (const std::int64_t step : {-1, 1}) {
        std::array<std::int64_t, 3> to = at;
        to.at(a) += step;
        if ((is_within(to) || surface.closed) && inside(surface, at) != inside(surface, to)) return true;
      }
    }
    return false;
  }

  const RandomFloats& volume_;
  std::vector<IndexedSurface> surfaces_;
};

// Samples that are needed must be called so, and what stands for others must lie on their side of all surfaces.
void expect_right(const RandomFloats& volume, const Surfaces& surfaces) {
  const auto index = volume.index();
  CrossedBricks bricks(*index, surfaces.all());
  for (std::int64_t k = 0; k < volume.dims[2]; ++k) {
    for (std::int64_t j = 0; j < volume.dims[1]; ++j) {
      std::vector<std::optional<float>> standing(static_cast<std::size_t>(volume.dims[0]));
      for (const UnneededRun& run : bricks.unneeded(j, k)) {
        float sample = 0;
        std::memcpy(&sample, run.sample.data(), sizeof sample);
        std::fill(standing.begin() + run.begin, standing.begin() + run.end, sample);
      }
      for (std::int64_t i = 0; i < volume.dims[0]; ++i) {
        const std::optional<float>& sample = standing[static_cast<std::size_t>(i)];
        EXPECT_EQ(bricks.any_in({{i, j, k}, {i + 1, j + 1, k + 1}}), !sample);
        if (!sample) continue;
        EXPECT_TRUE(surfaces.may_stand_for(*sample, {i, j, k}));
        EXPECT_FALSE(surfaces.need({i, j, k}));
      }
    }
  }
}

TEST(Index, EveryEndOfACrossedEdgeIsNeeded) {
  for (const auto& dims : kSizes) {
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
      const RandomFloats volume(dims, seed);
      const IndexedSurface surface{3.5, seed % 3 != 0, seed % 4 < 2, seed % 2};
      expect_right(volume, {volume, {surface}});
      expect_right(volume, {volume, {surface, {0.5, true, false, 0}, {6, seed % 3 != 0, seed % 4 < 2, 0}}});
    }
  }
}

// A raw file and its index.
struct IndexedFile {
  TempFolder folder;
  std::string path = folder / "a_40x35x50_float32.raw";
  std::string index = folder / "a.minmax";

  IndexedFile() {
    const RandomFloats volume({40, 35, 50}, 2);
    folder.put("a_40x35x50_float32.raw", stored(volume.samples));
    write_index(*build_index(*open_volume(path)), index);
  }

  std::string refusal() const {
    try {
      read_index(index, open_volume(path)->info());
    } catch (const BadInput& error) {
      return error.what();
    }
    return {};
  }
};

TEST(Index, TheFileHoldsAllOfIt) {
  const IndexedFile file;
  const auto written = build_index(*open_volume(file.path));
  const auto read = read_index(file.index, open_volume(file.path)->info());
  EXPECT_EQ(read->dims(), written->dims());
  EXPECT_EQ(read->identity(), written->identity());
  ASSERT_EQ(read->levels().size(), written->levels().size());
  for (std::size_t level = 0; level < read->levels().size(); ++level) {
    EXPECT_EQ(read->levels()[level].low, written->levels()[level].low);
    EXPECT_EQ(read->levels()[level].high, written->levels()[level].high);
    EXPECT_EQ(read->levels()[level].nan, written->levels()[level].nan);
  }
  ASSERT_EQ(read->slices().size(), 50U);
  EXPECT_EQ(read->slices()[7].crc, written->slices()[7].crc);
  EXPECT_EQ(read->slices()[7].range.max, written->slices()[7].range.max);
}

TEST(Index, OfAVolumeThatHasChangedIsRefused) {
  const IndexedFile file;
  EXPECT_EQ(file.refusal(), "");
  fs::last_write_time(file.path, fs::last_write_time(file.path) + std::chrono::nanoseconds(1000));
  EXPECT_TRUE(contains(file.refusal(), "a.minmax: expected the index of " + file.path)) << file.refusal();
  write_index(*build_index(*open_volume(file.path)), file.index);
  EXPECT_EQ(file.refusal(), "");
  // The same size and time, and another first sample.
  const auto time = fs::last_write_time(file.path);
  std::string content = get(file.path);
  content[1] ^= 1;
  file.folder.put("a_40x35x50_float32.raw", content);
  fs::last_write_time(file.path, time);
  EXPECT_NE(file.refusal(), "");
}

TEST(Index, OfAVolumeReadInAnotherWayIsRefused) {
  const IndexedFile file;
  OpenOptions options;
  options.raw = parse_raw_layout("40x35x50:float32:big");
  EXPECT_THROW(read_index(file.index, open_volume(file.path, options)->info()), BadInput);
  options.raw = parse_raw_layout("35x40x50:float32");
  EXPECT_THROW(read_index(file.index, open_volume(file.path, options)->info()), BadInput);
}

TEST(Index, KnowsItsVolumeInAnotherPlace) {
  const IndexedFile file;
  const TempFolder other;
  const std::string moved = other / "b_40x35x50_float32.raw";
  fs::copy_file(file.path, moved);
  fs::last_write_time(moved, fs::last_write_time(file.path));
  EXPECT_NE(read_index(file.index, open_volume(moved)->info()), nullptr);
}

TEST(Index, SamplesInOtherFilesBelongToIt) {
  const TempFolder folder;
  const std::string header = folder.put("a.mhd",
                                        "ObjectType = Image\nNDims = 3\nDimSize = 3 2 5\nElementType = MET_SHORT\n"
                                        "ElementDataFile = a.raw\n");
  const std::string data = folder.put("a.raw", stored(ramp<std::int16_t>(30)));
  write_index(*build_index(*open_volume(header)), folder / "i");
  EXPECT_NE(read_index(folder / "i", open_volume(header)->info()), nullptr);
  fs::last_write_time(data, fs::last_write_time(data) + std::chrono::seconds(3));
  EXPECT_THROW(read_index(folder / "i", open_volume(header)->info()), BadInput);
}

TEST(Index, DamagedFilesAreRefused) {
  const IndexedFile file;
  const std::string good = get(file.index);
  for (std::size_t length = 0; length < good.size(); length += 1 + length / 3) {
    file.folder.put("a.minmax", good.substr(0, length));
    EXPECT_NE(file.refusal(), "") << length;
  }
  for (std::size_t at = 0; at < good.size(); at += 1 + at / 50) {
    std::string bad = good;
    bad[at] ^= 0x10;
    file.folder.put("a.minmax", bad);
    EXPECT_NE(file.refusal(), "") << at;
  }
}

TEST(Index, AVolumeInNoFileHasNone) {
  const auto volume = generate_volume({"sphere", {20, 20, 20}});
  EXPECT_TRUE(index_places(volume->info()).empty());
  const TempFolder folder;
  EXPECT_THROW(write_index(*build_index(*volume), folder / "a"), BadInput);
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(Index, IsFoundBesideItsFile) {
  const IndexedFile file;
  const VolumeInfo info = open_volume(file.path)->info();
  EXPECT_EQ(find_index(info), "");
  write_index(*build_index(*open_volume(file.path)), index_places(info).at(0));
  EXPECT_EQ(find_index(info), file.path + ".minmax");
}

TEST(Index, IsFoundInTheCache) {
  const IndexedFile file;
  const TempFolder cache;
  ::setenv("XDG_CACHE_HOME", (cache / "").c_str(), 1);
  const VolumeInfo info = open_volume(file.path)->info();
  const std::vector<std::string> places = index_places(info);
  ::unsetenv("XDG_CACHE_HOME");
  ASSERT_EQ(places.size(), 2U);
  EXPECT_TRUE(places[1].starts_with(cache / "isoweave/a_40x35x50_float32.raw-")) << places[1];
  fs::create_directories(cache / "isoweave");
  fs::rename(file.index, places[1]);
  ::setenv("XDG_CACHE_HOME", (cache / "").c_str(), 1);
  EXPECT_EQ(find_index(info), places[1]);
  ::unsetenv("XDG_CACHE_HOME");
}

TEST(Index, RowsOfRawFilesAreSkipped) {
  const TempFolder folder;
  const std::string path = folder / "a_600x200x40_int16.raw";
  std::vector<std::int16_t> samples(600 * 200 * 40);
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<std::int16_t>(n / 600 % 200);
  folder.put("a_600x200x40_int16.raw", stored(samples));
  const MeshReport report = expect_same_with_index(path, 100);
  EXPECT_GT(report.left_out->bytes_left_out, samples.size());
  EXPECT_LT(report.left_out->bytes_left_out, 2 * samples.size());
}

}  // namespace
}  // namespace isoweave::testing::volume_index_test
