// Zarr 2 and 3, OME-Zarr: folders written by hand.
#include <sys/resource.h>

#include "index_helpers.hpp"
#include "sanitized.hpp"
#include "volume/row_source.hpp"
#include "zarr_helpers.hpp"

namespace isoweave::testing::volume_zarr_test {
namespace {

using namespace zarr_files;

const std::vector<std::int16_t> kExpected = expected_samples<std::int16_t>({5, 4, 3});

TEST(Zarr2, PlainChunksInBothOrdersOfAxesAndBytes) {
  const TempFolder folder;
  put_zarr2(folder / "c");
  EXPECT_EQ(read_file<std::int16_t>(folder / "c"), kExpected);
  put_zarr2(folder / "f", {{"order", "F"}}, {.fortran = true});
  EXPECT_EQ(read_file<std::int16_t>(folder / "f"), kExpected);
  put_zarr2(folder / "big", {{"dtype", ">i2"}, {"dimension_separator", "/"}}, {.big = true});
  EXPECT_EQ(read_file<std::int16_t>(folder / "big"), kExpected);
  put_zarr2<double>(folder / "real", {{"dtype", "<f8"}});
  EXPECT_EQ(read_file<double>(folder / "real"), expected_samples<double>({5, 4, 3}));
  const VolumeInfo info = open_volume(folder / "c")->info();
  EXPECT_EQ(info.format, "zarr");
  EXPECT_EQ(info.header, folder / "c/.zarray");
  EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{5, 4, 3}));
}

TEST(Zarr2, SlicesAreReadInAnyStepsForward) {
  const TempFolder folder;
  put_zarr2(folder / "a");
  for (const std::int64_t at_once : {1, 2, 3}) {
    EXPECT_EQ(samples_of<std::int16_t>(*open_volume(folder / "a"), at_once), kExpected) << at_once;
  }
  const auto source = open_volume(folder / "a");
  EXPECT_TRUE(source->skips());
  std::vector<std::int16_t> last(20);
  source->read(2, 1, std::as_writable_bytes(std::span(last)));
  EXPECT_TRUE(std::equal(last.begin(), last.end(), kExpected.begin() + 40));
}

TEST(Zarr2, ChunksThatAreLeftOutAreTheFillValue) {
  const TempFolder folder;
  put_zarr2(folder / "a", {{"fill_value", -7}, {"dtype", ">i2"}}, {.big = true});
  std::filesystem::remove(folder / "a/0.0.1");
  std::vector<std::int16_t> expected = kExpected;
  for (const std::size_t k : std::vector<std::size_t>{0, 1}) {
    for (const std::size_t j : std::vector<std::size_t>{0, 1, 2}) {
      for (const std::size_t i : std::vector<std::size_t>{2, 3}) expected[20 * k + 5 * j + i] = -7;
    }
  }
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), expected);
  put_zarr2<float>(folder / "nan", {{"fill_value", "NaN"}, {"dtype", "<f4"}});
  std::filesystem::remove(folder / "nan/0.0.0");
  EXPECT_TRUE(std::isnan(read_file<float>(folder / "nan")[0]));
  put_zarr2(folder / "large", {{"fill_value", 40000}});
  EXPECT_TRUE(contains(refusal(folder / "large"), "expected a fill value of int16"));
}

// Those that no double holds, too.
TEST(Zarr2, FillValuesOf64BitsAreNotRounded) {
  const TempFolder folder;
  const auto expect_fill = [&]<class Sample>(const std::string& dtype, const ArrayJson& fill, Sample expected) {
    put_zarr2<Sample>(folder / "a", {{"fill_value", fill}, {"dtype", dtype}});
    std::filesystem::remove(folder / "a/0.0.0");
    EXPECT_EQ(read_file<Sample>(folder / "a")[0], expected) << dtype;
  };
  expect_fill("<u8", 18446744073709551615U, ~std::uint64_t{0});
  expect_fill("<u8", 9007199254740993U, std::uint64_t{9007199254740993});
  expect_fill("<i8", -9007199254740993, std::int64_t{-9007199254740993});
  expect_fill("<i8", -7.0, std::int64_t{-7});
  for (const auto& [dtype, fill] : std::vector<std::pair<std::string, ArrayJson>>{
           {"<u8", -1}, {"<i8", 9223372036854775808U}, {"<i8", 0.5}, {"<u8", 1e300}}) {
    put_zarr2(folder / "b", {{"fill_value", fill}, {"dtype", dtype}});
    EXPECT_TRUE(contains(refusal(folder / "b"), "expected a fill value of")) << dtype;
  }
}

// Samples whose bits, as halves, are 1, 2, ...: multiples of 2^-24.
TEST(Zarr2, HalvesAreReadAsFloats) {
  const TempFolder folder;
  std::vector<float> expected;
  for (const std::int64_t bits : expected_samples<std::int64_t>({5, 4, 3})) {
    expected.push_back(static_cast<float>(bits) * 0x1p-24F);
  }
  put_zarr2<std::uint16_t>(folder / "a", {{"dtype", "<f2"}});
  EXPECT_EQ(read_file<float>(folder / "a"), expected);
  put_zarr2<std::uint16_t>(folder / "b", {{"dtype", ">f2"}}, {.big = true});
  EXPECT_EQ(read_file<float>(folder / "b"), expected);
  put_zarr3<std::uint16_t>(folder / "c", {{"data_type", "float16"}});
  EXPECT_EQ(read_file<float>(folder / "c"), expected);
  const std::vector<std::pair<ArrayJson, float>> fills{
      {-1.5, -1.5F}, {"0x3c01", 1 + 0x1p-10F}, {"Infinity", std::numeric_limits<float>::infinity()}, {nullptr, 0.0F}};
  for (const auto& [fill, value] : fills) {
    ArrayJson metadata = kZarr3;
    metadata.update({{"data_type", "float16"}, {"fill_value", fill}});
    put_json(folder / "d/zarr.json", metadata);
    EXPECT_EQ(read_file<float>(folder / "d"), std::vector<float>(60, value)) << fill;
  }
  for (const ArrayJson& fill : {ArrayJson("0x7fc00000"), ArrayJson(70000), ArrayJson("x")}) {
    put_zarr2<std::uint16_t>(folder / "e", {{"dtype", "<f2"}, {"fill_value", fill}});
    EXPECT_TRUE(contains(refusal(folder / "e"), "a fill value of float16")) << fill;
  }
}

TEST(Zarr2, Codecs) {
  const TempFolder folder;
  put_zarr2(folder / "gzip", {{"compressor", {{"id", "gzip"}}}}, {}, gzipped);
  EXPECT_EQ(read_file<std::int16_t>(folder / "gzip"), kExpected);
  put_zarr2(folder / "zlib", {{"compressor", {{"id", "zlib"}}}}, {}, zlibbed);
  EXPECT_EQ(read_file<std::int16_t>(folder / "zlib"), kExpected);
  put_zarr2(folder / "bz2", {{"compressor", {{"id", "bz2"}}}});
  EXPECT_TRUE(contains(refusal(folder / "bz2"), "expected compressor gzip, zlib, zstd, blosc or lz4, found 'bz2'"));
  put_zarr2(folder / "filter", {{"filters", {{{"id", "delta"}}}}});
  EXPECT_TRUE(contains(refusal(folder / "filter"), "filter 'delta'"));
}

#ifdef ISOWEAVE_HAS_ZSTD
TEST(Zarr2, Zstd) {
  const TempFolder folder;
  put_zarr2(folder / "a", {{"compressor", {{"id", "zstd"}}}}, {}, zstd);
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), kExpected);
  put_file(folder / "a/0.0.0", zstd(std::string(25, 'x')));
  EXPECT_TRUE(contains(refusal(folder / "a"), "0.0.0: expected at most 24 bytes in zstd"));
}
#endif

#ifdef ISOWEAVE_HAS_BLOSC
TEST(Zarr2, Blosc) {
  const TempFolder folder;
  put_zarr2(folder / "a", {{"compressor", {{"id", "blosc"}}}}, {}, blosc);
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), kExpected);
  put_file(folder / "a/0.0.0", blosc(std::string(25, 'x')));
  EXPECT_TRUE(contains(refusal(folder / "a"), "0.0.0: expected at most 24 bytes in Blosc"));
  put_file(folder / "a/0.0.0", "no Blosc at all");
  EXPECT_TRUE(contains(refusal(folder / "a"), "in Blosc, found other data"));
}
#endif

#ifdef ISOWEAVE_HAS_LZ4
TEST(Zarr2, Lz4) {
  const TempFolder folder;
  put_zarr2(folder / "a", {{"compressor", {{"id", "lz4"}}}}, {}, lz4);
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), kExpected);
  put_file(folder / "a/0.0.0", lz4(std::string(25, 'x')));
  EXPECT_TRUE(contains(refusal(folder / "a"), "expected at most 24 bytes in LZ4, found 25"));
}
#endif

TEST(Zarr2, DamageIsRefusedByTheFileItIsIn) {
  const TempFolder folder;
  const auto refused = [&folder](const ArrayJson& changes) {
    put_zarr2(folder / "a", changes);
    return refusal(folder / "a");
  };
  EXPECT_TRUE(contains(refused({{"dtype", "<c8"}}), ".zarray: expected a dtype of integers of 8 to 64 bits"));
  EXPECT_TRUE(contains(refused({{"dtype", ""}}), "expected a dtype"));
  EXPECT_TRUE(contains(refused({{"order", "X"}}), "expected order C or F, found 'X'"));
  EXPECT_TRUE(contains(refused({{"chunks", {2, 3}}}), "expected chunks of 3 axes, found 2"));
  EXPECT_TRUE(contains(refused({{"chunks", {2, 3, 0}}}), "expected chunks of 1 to 2^40 samples"));
  EXPECT_TRUE(contains(refused({{"shape", {3, 4, -5}}}), "expected axes of at least one sample"));
  EXPECT_TRUE(contains(refused({{"shape", {3, 4, "x"}}}), "expected a list of integers as 'shape'"));
  EXPECT_TRUE(contains(refused({{"shape", {3, 4, 5e9}}}), "expected a list of integers as 'shape'"));
  EXPECT_TRUE(contains(refused({{"zarr_format", 1}}), "expected zarr_format 2"));
  EXPECT_TRUE(contains(refused({{"dimension_separator", "-"}}), "expected dimension_separator"));
  put_zarr2(folder / "a");
  put_file(folder / "a/0.0.0", "short");
  EXPECT_TRUE(contains(refusal(folder / "a"), "0.0.0: expected a chunk of 24 bytes, found 5"));
  put_file(folder / "a/0.0.0", std::string(9000, 'x'));
  EXPECT_TRUE(contains(refusal(folder / "a"), "0.0.0: expected at most 4120 bytes, found 9000"));
  put_file(folder / "a/0.0.0", "");
  EXPECT_TRUE(contains(refusal(folder / "a"), "0.0.0: expected a chunk, found no bytes"));
  put_file(folder / "a/.zarray", "");
  EXPECT_TRUE(contains(refusal(folder / "a"), ".zarray: expected JSON, found an empty file"));
  put_file(folder / "a/.zarray", "{\"zarr_format\": 2,");
  EXPECT_TRUE(contains(refusal(folder / "a"), ".zarray: expected JSON"));
  put_file(folder / "a/.zarray", std::string(200, '[') + std::string(200, ']'));
  EXPECT_TRUE(contains(refusal(folder / "a"), "levels"));
}

TEST(Zarr2, ClaimsBeyondWhatIsStoredAreRefusedBeforeMemoryIsTaken) {
  const TempFolder folder;
  put_zarr2(folder / "a", {{"shape", {2, 1 << 30, 1 << 30}}, {"chunks", {2, 1 << 10, 1 << 10}}});
  EXPECT_TRUE(contains(refusal(folder / "a"), "which cannot hold them"));
  put_zarr2(folder / "b", {{"shape", {1 << 30, 1 << 30, 1 << 30}}, {"chunks", {2, 3, 2}}});
  EXPECT_TRUE(contains(refusal(folder / "b"), "expected a volume of fewer than 2^63 bytes"));
  put_zarr2(folder / "c", {{"chunks", {1 << 12, 1 << 12, 1 << 14}}, {"compressor", {{"id", "zlib"}}}}, {}, zlibbed);
  EXPECT_TRUE(contains(refusal(folder / "c"), "which cannot hold them"));
}

// Half a million chunks in a slice of half a megabyte: what is held must not grow with their number.
TEST(Zarr2, ManySmallChunksTakeNoMemoryOfTheirOwn) {
  if (kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const TempFolder folder;
  ArrayJson metadata = kZarr2;
  metadata.update({{"shape", {1, 512, 1024}}, {"chunks", {1, 1, 1}}, {"dtype", "|u1"}, {"fill_value", 2}});
  put_json(folder / "a/.zarray", metadata);
  put_file(folder / "a/0.0.0", "7");
  const auto most_held = [] {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;  // KiB
  };
  const auto before = most_held();
  const auto samples = read_file<std::uint8_t>(folder / "a");
  EXPECT_LT(most_held() - before, 8 << 10);
  EXPECT_EQ(samples[0], '7');
  EXPECT_EQ(samples.back(), 2);
}

TEST(Zarr2, ChangedBytesOfMetadataAreSafe) {
  const TempFolder folder;
  put_zarr2(folder / "a");
  const std::string good = get(folder / "a/.zarray");
  std::mt19937 random(20260301);
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string broken = good;
    for (int flips = 1 + round % 3; flips > 0; --flips)
      broken[random() % good.size()] = static_cast<char>(random() & 0xff);
    put_file(folder / "a/.zarray", broken);
    if (!reads_or_refuses(folder / "a")) ++refused;
  }
  EXPECT_GT(refused, 1000);
}

TEST(Zarr3, PlainTransposedAndBigEndian) {
  const TempFolder folder;
  put_zarr3(folder / "a");
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), kExpected);
  EXPECT_EQ(open_volume(folder / "a")->info().format, "zarr");
  const ArrayJson turned = {{{"name", "transpose"}, {"configuration", {{"order", {2, 1, 0}}}}},
                            {{"name", "bytes"}, {"configuration", {{"endian", "big"}}}}};
  put_zarr3(folder / "t", {{"codecs", turned}}, {.big = true, .fortran = true});
  EXPECT_EQ(read_file<std::int16_t>(folder / "t"), kExpected);
  put_zarr3<std::uint8_t>(folder / "bool", {{"data_type", "bool"}, {"fill_value", false}, {"codecs", {"bytes"}}});
  EXPECT_EQ(open_volume(folder / "bool")->info().type, SampleType::kUint8);
}

TEST(Zarr3, GzipBehindAChecksum) {
  EXPECT_EQ(crc32c(std::as_bytes(std::span(std::string_view("123456789")))), 0xe3069283U);
  const TempFolder folder;
  const ArrayJson codecs = {kZarr3["codecs"][0], {{"name", "gzip"}}, {{"name", "crc32c"}}};
  put_zarr3(folder / "a", {{"codecs", codecs}}, {}, [](const std::string& data) { return with_sum(gzipped(data)); });
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), kExpected);
  std::string damaged = get(folder / "a/c/0/0/0");
  damaged[5] = static_cast<char>(damaged[5] ^ 1);
  put_file(folder / "a/c/0/0/0", damaged);
  EXPECT_TRUE(contains(refusal(folder / "a"), "c/0/0/0: expected data of their CRC-32C, found damaged data"));
}

TEST(Zarr3, Shards) {
  const TempFolder folder;
  std::vector<std::int16_t> expected = kExpected;
  for (const std::size_t k : std::vector<std::size_t>{0, 1, 2}) {
    for (const std::size_t i : std::vector<std::size_t>{2, 3}) expected[20 * k + 5 * 3 + i] = 9;
  }
  put_shards(folder / "end", true);
  EXPECT_EQ(read_file<std::int16_t>(folder / "end"), expected);
  put_shards(folder / "start", false);
  EXPECT_EQ(read_file<std::int16_t>(folder / "start"), expected);
  const std::string path = folder / "end/c/0/0/0";
  const std::string good = get(path);
  for (std::size_t length = 1; length < good.size(); ++length) {
    put_file(path, good.substr(0, length));
    EXPECT_FALSE(reads_or_refuses(folder / "end")) << length;
  }
  put_file(path, good.substr(0, good.size() - 60) + std::string(60, '\0'));
  EXPECT_TRUE(contains(refusal(folder / "end"), "CRC-32C"));
}

TEST(Zarr3, WhatIsNotReadIsRefusedByName) {
  const TempFolder folder;
  const auto refused = [&folder](const ArrayJson& changes) {
    put_zarr3(folder / "a", changes);
    return refusal(folder / "a");
  };
  const ArrayJson bytes = kZarr3["codecs"][0];
  EXPECT_TRUE(contains(refused({{"codecs", {bytes, {{"name", "lzma"}}}}}), "found 'lzma'"));
  EXPECT_TRUE(contains(refused({{"codecs", {{{"name", "vlen-utf8"}}}}}), "found 'vlen-utf8'"));
  EXPECT_TRUE(contains(refused({{"codecs", ArrayJson::array()}}), "found neither"));
  EXPECT_TRUE(contains(refused({{"data_type", "complex64"}}), "found 'complex64'"));
  EXPECT_TRUE(contains(refused({{"chunk_grid", {{"name", "rectangular"}}}}), "found 'rectangular'"));
  EXPECT_TRUE(contains(refused({{"chunk_key_encoding", {{"name", "hash"}}}}), "found 'hash'"));
  EXPECT_TRUE(contains(refused({{"node_type", "table"}}), "expected node_type array or group"));
  EXPECT_TRUE(contains(refused({{"storage_transformers", {1}}}), "storage_transformers"));
  const ArrayJson turned = {{{"name", "transpose"}, {"configuration", {{"order", {0, 1, 1}}}}}, bytes};
  EXPECT_TRUE(contains(refused({{"codecs", turned}}), "an order of all axes"));
}

TEST(Zarr3, FieldsThatMustBeUnderstoodAreRefused) {
  const TempFolder folder;
  for (const ArrayJson& value :
       {ArrayJson(1), ArrayJson::object(), ArrayJson({{"name", "x"}}), ArrayJson({{"must_understand", true}})}) {
    put_zarr3(folder / "a", {{"mask", value}});
    EXPECT_TRUE(contains(refusal(folder / "a"), "zarr.json: expected fields of Zarr 3")) << value;
    put_zarr3(folder / "b/c");
    put_json(folder / "b/zarr.json", {{"zarr_format", 3}, {"node_type", "group"}, {"mask", value}});
    EXPECT_TRUE(contains(refusal(folder / "b"), "found 'mask'")) << value;
  }
  put_zarr3(folder / "a", {{"mask", {{"must_understand", false}}}, {"attributes", {{"must_understand", true}}}});
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), kExpected);
  put_json(folder / "b/zarr.json", {{"zarr_format", 3}, {"node_type", "group"}, {"consolidated_metadata", nullptr}});
  EXPECT_EQ(read_file<std::int16_t>(folder / "b"), kExpected);
}

TEST(Zarr, LinksOutOfTheFolderAreRefusedWhereTheyAreNotTrusted) {
  const TempFolder folder;
  OpenOptions options;
  options.external = false;
  put_zarr2(folder / "a.zarr");
  EXPECT_EQ(read_all(*open_volume(folder / "a.zarr", options)).size(), 120U);
  std::filesystem::rename(folder / "a.zarr/0.0.0", folder / "chunk");
  std::filesystem::create_symlink("../chunk", folder / "a.zarr/0.0.0");
  EXPECT_EQ(read_all(*open_volume(folder / "a.zarr")).size(), 120U);
  EXPECT_THROW(read_all(*open_volume(folder / "a.zarr", options)), BadInput);
  std::filesystem::create_directory_symlink("a.zarr", folder / "link.zarr");
  std::filesystem::remove(folder / "a.zarr/0.0.0");
  std::filesystem::create_symlink("0.0.1", folder / "a.zarr/0.0.0");
  EXPECT_EQ(read_all(*open_volume(folder / "link.zarr", options)).size(), 120U);
  std::filesystem::rename(folder / "a.zarr/.zarray", folder / "metadata");
  std::filesystem::create_symlink("../metadata", folder / "a.zarr/.zarray");
  EXPECT_EQ(read_all(*open_volume(folder / "a.zarr")).size(), 120U);
  EXPECT_THROW(open_volume(folder / "a.zarr", options), BadInput);
}

// The chunks that are not needed cannot be read.
TEST(Zarr, ChunksThatTheSurfaceMissesAreNotRead) {
  const TempFolder folder;
  const std::array<std::int64_t, 3> dims{70, 40, 100};
  const ChunkOf chunks{dims, {20, 20, 20}};
  const ArrayJson gzip = {{"id", "gzip"}, {"level", 1}};
  put_zarr2(folder / "a.zarr", {{"shape", {100, 40, 70}}, {"chunks", {20, 20, 20}}, {"compressor", gzip}}, chunks,
            gzipped);
  const double iso = 131 * 30;  // between slices 26 and 31
  const MeshReport whole = expect_same_with_index(folder / "a.zarr", iso, Normals::kGradient);
  EXPECT_EQ(whole.left_out->chunks, 40U);
  EXPECT_EQ(whole.left_out->chunks_left_out, 24U);
  for (const char* name : {"3.0.0", "3.1.2", "4.0.1", "4.1.3"}) {
    const std::string path = folder / "a.zarr/" + name;
    const auto time = std::filesystem::last_write_time(path);
    std::ofstream(path, std::ios::binary | std::ios::in) << std::string(std::filesystem::file_size(path), 'x');
    std::filesystem::last_write_time(path, time);
  }
  EXPECT_THROW(run_file(folder / "a.zarr", iso, {}, Normals::kAbsent), BadInput);
  const MeshReport kept = run_file(folder / "a.zarr", iso, folder / "a.zarr.test-index", Normals::kGradient);
  EXPECT_EQ(kept.digest, whole.digest);
  EXPECT_EQ(kept.max, whole.max);
  // In an index of another state of the folder nobody trusts.
  std::filesystem::remove(folder / "a.zarr/4.1.3");
  EXPECT_THROW(run_file(folder / "a.zarr", iso, folder / "a.zarr.test-index", Normals::kAbsent), BadInput);
}

// Every box of a volume of 5 x 4 x 3 samples, by itself and as a part of a larger part.
template <class Sample>
void expect_boxes(const std::string& path) {
  const std::vector<Sample> whole = read_file<Sample>(path);
  EXPECT_TRUE(open_volume(path)->reads_boxes());
  for (std::int64_t n = 0; n < 5 * 5 * 4 * 4 * 3 * 3; ++n) {
    const Region box{{n % 5, n / 25 % 4, n / 400 % 3}, {n / 5 % 5 + 1, n / 100 % 4 + 1, n / 1200 + 1}};
    if (box.first[0] >= box.end[0] || box.first[1] >= box.end[1] || box.first[2] >= box.end[2]) continue;
    std::vector<Sample> expected;
    for (std::int64_t k = box.first[2]; k < box.end[2]; ++k) {
      for (std::int64_t j = box.first[1]; j < box.end[1]; ++j) {
        const auto row = whole.begin() + 20 * k + 5 * j;
        expected.insert(expected.end(), row + box.first[0], row + box.end[0]);
      }
    }
    SCOPED_TRACE(::testing::Message() << path << ' ' << n);
    EXPECT_EQ(samples_of<Sample>(*crop_volume(open_volume(path), box), 1 + n % 2), expected);
    const std::int64_t corner = box.first[0] / 2;
    auto larger = crop_volume(open_volume(path), {{corner, 0, 0}, {5, box.end[1], 3}});
    const Region inner{{box.first[0] - corner, box.first[1], box.first[2]},
                       {box.end[0] - corner, box.end[1], box.end[2]}};
    EXPECT_EQ(samples_of<Sample>(*crop_volume(std::move(larger), inner), 1), expected);
  }
}

TEST(Zarr, BoxesAreThoseOfTheWhole) {
  const TempFolder folder;
  put_zarr2(folder / "c", {{"fill_value", -7}});
  std::filesystem::remove(folder / "c/0.0.1");
  expect_boxes<std::int16_t>(folder / "c");
  put_zarr2(folder / "f", {{"order", "F"}}, {.fortran = true});
  expect_boxes<std::int16_t>(folder / "f");
  put_zarr3<std::uint16_t>(folder / "half", {{"data_type", "float16"}});
  expect_boxes<float>(folder / "half");
  put_shards(folder / "shards", true);
  expect_boxes<std::int16_t>(folder / "shards");
  put_n5(folder / "n5", "raw");
  expect_boxes<std::int16_t>(folder / "n5");
}

// A box of a volume whose bands are a thousand times as large as that of the box.
TEST(Zarr, ABoxHoldsItsOwnBandAlone) {
  const TempFolder folder;
  put_json(folder / "a/.zarray", {{"zarr_format", 2},
                                  {"shape", {64, 40000, 40000}},
                                  {"chunks", {32, 32, 32}},
                                  {"dtype", "|u1"},
                                  {"order", "C"},
                                  {"fill_value", 3},
                                  {"compressor", nullptr},
                                  {"filters", nullptr}});
  for (const char* const chunk : {"a/0.1200.31", "a/0.0.0"}) put_file(folder / chunk, std::string(32 * 32 * 32, 'a'));
  auto volume = crop_volume(open_volume(folder / "a"), {{1000, 38420, 0}, {1100, 38432, 40}});
  EXPECT_LT(held_by_slices(*volume), 1'000'000U);
  const std::vector<std::uint8_t> samples = samples_of<std::uint8_t>(*volume, 3);
  // The chunk begins at 992, 38400, 0.
  EXPECT_EQ(std::count(samples.begin(), samples.end(), 'a'), 24 * 12 * 32);
  EXPECT_EQ(std::count(samples.begin(), samples.end(), 3), 100 * 12 * 40 - 24 * 12 * 32);
}

}  // namespace
}  // namespace isoweave::testing::volume_zarr_test
