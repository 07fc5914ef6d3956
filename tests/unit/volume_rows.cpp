// Slices read by rows.
#include <gtest/gtest.h>

#include "isoweave/generate.hpp"
#include "volume/row_source.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing::volume_rows_test {
namespace {

using Open = std::function<std::unique_ptr<SliceSource>()>;

// Rows, so many at a time, are those of the slices.
void expect_same(const Open& open, std::int64_t rows) {
  const auto whole = open();
  const VolumeInfo& info = whole->info();
  const std::vector<std::byte> expected = read_all(*whole);
  const std::size_t row = info.slice_bytes() / static_cast<std::size_t>(info.dims[1]);
  const auto source = open();
  RowReader reader(*source);
  std::vector<std::byte> got;
  for (std::int64_t k = 0; k < info.dims[2]; ++k) {
    for (std::int64_t j = 0; j < info.dims[1]; j += rows) {
      const std::int64_t count = std::min(rows, info.dims[1] - j);
      std::vector<std::byte> block(static_cast<std::size_t>(count) * row);
      reader.read(k, j, count, block);
      got.insert(got.end(), block.begin(), block.end());
    }
  }
  EXPECT_EQ(got, expected);
}

std::string nrrd_of(const std::string& encoding, const std::string& samples) {
  return "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 5 3\nendian: big\nencoding: " + encoding + "\n\n" + samples;
}

TEST(Rows, AreThoseOfTheSlices) {
  const TempFolder folder;
  const std::string samples = stored(ramp<std::int16_t>(60), true);
  const std::string plain = folder.put("a.nrrd", nrrd_of("raw", samples));
  const std::string packed = folder.put("b.nrrd", nrrd_of("gzip", gzipped(samples)));
  const std::vector<Open> sources{
      [&] { return open_volume(plain); },
      [&] { return open_volume(packed); },
      [] {
        return generate_volume({"noise", {7, 6, 4}, SampleType::kFloat32});
      },
      [&] {
        return crop_volume(open_volume(plain), {{1, 1, 1}, {3, 5, 3}});
      },
      [&] { return downsample_volume(open_volume(plain), 2); },  // has no rows of its own
  };
  for (const Open& open : sources) {
    for (const std::int64_t rows : {1, 2, 100}) expect_same(open, rows);
  }
}

TEST(Rows, OnlyMoveForward) {
  const TempFolder folder;
  const auto volume = open_volume(folder.put("a.nrrd", nrrd_of("raw", stored(ramp<std::int16_t>(60), true))));
  RowReader reader(*volume);
  std::vector<std::byte> rows(16);
  reader.read(1, 2, 2, rows);
  EXPECT_THROW(reader.read(1, 3, 1, rows), std::invalid_argument);
  EXPECT_THROW(reader.read(0, 4, 1, rows), std::invalid_argument);
  EXPECT_THROW(reader.read(1, 4, 2, rows), std::invalid_argument);
  EXPECT_THROW(reader.read(3, 0, 1, rows), std::invalid_argument);
  EXPECT_THROW(reader.read(2, 0, 3, rows), std::invalid_argument);
  std::vector<std::byte> slice(40);
  EXPECT_THROW(volume->read(1, 1, slice), std::invalid_argument);  // of which rows are behind
  volume->read(2, 1, slice);
  EXPECT_EQ(std::to_integer<int>(slice[0]), (40 * 7 + 3) & 255);
}

TEST(Rows, ThatEndEarlyAreBadInput) {
  const TempFolder folder;
  const std::string samples = gzipped(stored(ramp<std::int16_t>(50), true));
  const auto volume = open_volume(folder.put("a.nrrd", nrrd_of("gzip", samples)));
  RowReader reader(*volume);
  std::vector<std::byte> row(8);
  reader.read(2, 0, 1, row);
  EXPECT_THROW(reader.read(2, 4, 1, row), BadInput);
}

// A label map that holds much while it is read.
class LargeMap final : public BufferedSource {
 public:
  static constexpr std::uint64_t kHeld = 1'000'000;

  const VolumeInfo& info() const override { return info_; }
  std::uint64_t held_bytes() const override { return kHeld; }
  void read(std::int64_t, std::int64_t, std::span<std::byte> out) override {
    std::fill(out.begin(), out.end(), std::byte{1});
  }

 private:
  const VolumeInfo info_ = generate_volume({"noise", {6, 5, 4}, SampleType::kUint8})->info();
};

// Caps on memory count what a volume holds that others are made of.
TEST(HeldBytes, AreToldByVolumesThatAreMadeOfOthers) {
  const auto map = [] { return std::make_unique<LargeMap>(); };
  const std::uint64_t slice = map()->info().slice_bytes();
  EXPECT_EQ(held_by_slices(*map()), LargeMap::kHeld);
  EXPECT_EQ(held_by_rows(*map()), LargeMap::kHeld + slice);
  const std::vector<Open> sources{
      [&] { return downsample_volume(map(), 2); },
      [&] { return smooth_mask(map(), {}, 1); },
      [&] { return label_volume(map(), Label(1)); },
      [&] {
        return crop_volume(map(), {{0, 0, 0}, {3, 3, 3}});
      },
      [&] {
        return crop_volume(downsample_volume(map(), 2), {{0, 0, 0}, {2, 2, 2}});
      },
  };
  for (const Open& open : sources) EXPECT_GE(held_by_slices(*open()), LargeMap::kHeld + slice);
  EXPECT_LT(held_by_slices(*sources.front()()), LargeMap::kHeld + 10 * slice);
}

}  // namespace
}  // namespace isoweave::testing::volume_rows_test
