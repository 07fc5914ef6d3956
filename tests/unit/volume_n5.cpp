// N5: folders written by hand.
#include "zarr_helpers.hpp"

namespace isoweave::testing::volume_n5_test {
namespace {

using namespace zarr_files;

const std::vector<std::int16_t> kExpected = expected_samples<std::int16_t>({5, 4, 3});

TEST(N5, BlocksThatEndWithTheArray) {
  const TempFolder folder;
  put_n5(folder / "raw", "raw");
  EXPECT_EQ(read_file<std::int16_t>(folder / "raw"), kExpected);
  EXPECT_EQ(open_volume(folder / "raw")->info().format, "n5");
  put_n5(folder / "gzip", "gzip", {}, gzipped);
  EXPECT_EQ(read_file<std::int16_t>(folder / "gzip"), kExpected);
  put_n5(folder / "xz", "xz");
  EXPECT_TRUE(contains(refusal(folder / "xz"), "expected compression raw, gzip, zstd, blosc or lz4, found 'xz'"));
  std::filesystem::remove(folder / "raw/0/0/0");
  EXPECT_EQ(read_file<std::int16_t>(folder / "raw")[0], 0);
}

#ifdef ISOWEAVE_HAS_LZ4
// One block kept as it is, one of 20 equal bytes, and the empty one that ends a stream.
TEST(N5, Lz4Frames) {
  const TempFolder folder;
  const auto frame = [](char method, const std::string& stored, std::uint32_t bytes) {
    return std::string("LZ4Block") + method + bytes_of(static_cast<std::uint32_t>(stored.size())) + bytes_of(bytes) +
           std::string(4, '\0') + stored;
  };
  const std::string same = std::string("\x17") + "a" + std::string("\x01\x00", 2) + "\x80" + "aaaaaaaa";
  put_n5(folder / "a", "lz4", {{"dataType", "uint8"}, {"dimensions", {20, 2}}, {"blockSize", {20, 2}}});
  const std::string head = bytes_of(std::uint16_t{0}, true) + bytes_of(std::uint16_t{2}, true) +
                           bytes_of(std::uint32_t{20}, true) + bytes_of(std::uint32_t{2}, true);
  const std::string plain = "01234567890123456789";
  put_file(folder / "b/0/0", head + frame('\x10', plain, 20) + frame('\x25', same, 20) + frame('\x10', "", 0));
  put_json(folder / "b/attributes.json", get(folder / "a/attributes.json").empty()
                                             ? ArrayJson()
                                             : ArrayJson::parse(get(folder / "a/attributes.json")));
  const auto samples = read_file<std::uint8_t>(folder / "b");
  EXPECT_EQ(std::string(samples.begin(), samples.end()), plain + std::string(20, 'a'));
  put_file(folder / "b/0/0", head + frame('\x10', plain, 20) + frame('\x25', same, 4000) + frame('\x10', "", 0));
  EXPECT_TRUE(contains(refusal(folder / "b"), "expected at most 40 bytes in LZ4"));
}
#endif

TEST(N5, DamagedBlocksAreRefused) {
  const TempFolder folder;
  put_n5(folder / "a", "raw");
  const std::string path = folder / "a/0/0/0";
  const std::string good = get(path);
  for (std::size_t length = 1; length < good.size(); ++length) {
    put_file(path, good.substr(0, length));
    EXPECT_FALSE(reads_or_refuses(folder / "a")) << length;
  }
  put_file(path, "");
  EXPECT_TRUE(contains(refusal(folder / "a"), "0/0/0: expected a chunk, found no bytes"));
  const auto refused = [&](std::size_t at, char byte) {
    std::string broken = good;
    broken[at] = byte;
    put_file(path, broken);
    return refusal(folder / "a");
  };
  EXPECT_TRUE(contains(refused(1, 1), "0/0/0: expected a block of the default mode, found mode 1"));
  EXPECT_TRUE(contains(refused(3, 4), "expected a block of the array's axes"));
  EXPECT_TRUE(contains(refused(7, 9), "expected a block of at most 2 samples along an axis, found 9"));
  EXPECT_TRUE(contains(refused(7, 1), "expected a chunk of 12 bytes, found 24"));
}

TEST(N5, LevelsAndTheirPlaces) {
  const TempFolder folder;
  put_json(folder / "a/attributes.json", {{"n5", "2.5.0"}});
  put_json(folder / "a/raw/attributes.json", {{"pixelResolution", {{"dimensions", {4, 4, 40}}, {"unit", "nm"}}}});
  put_n5(folder / "a/raw/s0", "raw");
  put_n5(folder / "a/raw/s1", "raw", {{"downsamplingFactors", {2, 2, 1}}});
  const VolumeInfo full = open_volume(folder / "a")->info();
  EXPECT_EQ(full.geometry.spacing, (std::array<double, 3>{4, 4, 40}));
  EXPECT_EQ(full.geometry.unit, "nm");
  OpenOptions options;
  options.level = 1;
  const VolumeInfo half = open_volume(folder / "a", options)->info();
  EXPECT_EQ(half.geometry.spacing, (std::array<double, 3>{8, 8, 40}));
  EXPECT_EQ(half.geometry.origin, (std::array<double, 3>{2, 2, 0}));
  EXPECT_EQ(half.part, "level 1");
  const VolumeInfo alone = open_volume(folder / "a/raw/s1")->info();
  EXPECT_EQ(alone.geometry.spacing, half.geometry.spacing);
  EXPECT_EQ(alone.geometry.origin, half.geometry.origin);
  EXPECT_EQ(alone.geometry.unit, "nm");
  EXPECT_TRUE(contains(alone.notes.back(), "level 's1' of the image in a folder above it"));
  // Factors of all levels in the group, by either name; none at all.
  for (const std::string key : {"scales", "downsamplingFactors", "nothing"}) {
    const std::string group = folder / ("d" + key);
    put_json(group + "/attributes.json", {{"n5", "2.5.0"}, {"resolution", {4, 4, 40}}, {key, {{1, 1, 1}, {2, 2, 1}}}});
    put_n5(group + "/s0", "raw");
    put_n5(group + "/s1", "raw");
    EXPECT_EQ(open_volume(group)->info().geometry.spacing, (std::array<double, 3>{4, 4, 40}));
    for (const VolumeInfo& info : {open_volume(group, options)->info(), open_volume(group + "/s1")->info()}) {
      EXPECT_EQ(info.geometry.spacing,
                (key == "nothing" ? std::array<double, 3>{4, 4, 40} : std::array<double, 3>{8, 8, 40}));
      const auto told = std::count_if(info.notes.begin(), info.notes.end(), [](const std::string& note) {
        return contains(note, "its spacing is that of level 0");
      });
      EXPECT_EQ(told, key == "nothing" ? 1 : 0);
    }
  }
  put_n5(folder / "b", "raw", {{"resolution", {1, 2, 3}}, {"units", {"um", "um", "um"}}, {"offset", {10, 20, 30}}});
  const Geometry geometry = open_volume(folder / "b")->info().geometry;
  EXPECT_EQ(geometry.spacing, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{10, 20, 30}));
  put_n5(folder / "c", "raw", {{"resolution", {1, 2, 3}}, {"units", {"nm", "nm", "um"}}, {"offset", {10, 20, 30}}});
  const Geometry mixed = open_volume(folder / "c")->info().geometry;
  put_n5(folder / "d", "raw", {{"pixelResolution", {1, 2, 3}}, {"offset", {10, 20, 30}}});
  EXPECT_EQ(open_volume(folder / "d")->info().geometry.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(mixed.spacing, (std::array<double, 3>{1, 2, 3000}));
  EXPECT_EQ(mixed.origin, (std::array<double, 3>{10, 20, 30000}));
}

}  // namespace
}  // namespace isoweave::testing::volume_n5_test
