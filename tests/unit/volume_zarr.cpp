// Zarr 2 and 3, OME-Zarr: folders written by hand.
#include "array_helpers.hpp"
#include "volume/chunk_codecs.hpp"

#ifdef ISOWEAVE_HAS_ZSTD
#include <zstd.h>
#endif
#ifdef ISOWEAVE_HAS_BLOSC
#include <blosc.h>
#endif
#ifdef ISOWEAVE_HAS_LZ4
#include <lz4.h>
#endif

namespace isoweave::testing {
namespace {

using Encode = std::function<std::string(const std::string&)>;

std::string plain(const std::string& data) { return data; }

const ArrayJson kZarr2 = {{"zarr_format", 2}, {"shape", {3, 4, 5}}, {"chunks", {2, 3, 2}},   {"dtype", "<i2"},
                          {"order", "C"},     {"fill_value", 0},    {"compressor", nullptr}, {"filters", nullptr}};

// A Zarr 2 array of 5 x 4 x 3 samples.
template <class Sample = std::int16_t>
void put_zarr2(const std::string& folder, const ArrayJson& changes = {}, const ChunkOf& chunks = {},
               const Encode& encode = plain) {
  ArrayJson metadata = kZarr2;
  if (!changes.is_null()) metadata.update(changes);
  put_json(folder + "/.zarray", metadata);
  const std::string separator = metadata.value("dimension_separator", ".");
  for_chunks(chunks, [&](std::int64_t k, std::int64_t j, std::int64_t i) {
    put_file(folder + "/" + key({k, j, i}, separator), encode(chunks.bytes<Sample>(k, j, i)));
  });
}

const ArrayJson kZarr3 = {{"zarr_format", 3},
                          {"node_type", "array"},
                          {"shape", {3, 4, 5}},
                          {"data_type", "int16"},
                          {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", {2, 3, 2}}}}}},
                          {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "/"}}}}},
                          {"fill_value", 0},
                          {"codecs", {{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}}}}};

template <class Sample = std::int16_t>
void put_zarr3(const std::string& folder, const ArrayJson& changes = {}, const ChunkOf& chunks = {},
               const Encode& encode = plain) {
  ArrayJson metadata = kZarr3;
  if (!changes.is_null()) metadata.update(changes);
  put_json(folder + "/zarr.json", metadata);
  for_chunks(chunks, [&](std::int64_t k, std::int64_t j, std::int64_t i) {
    put_file(folder + "/c/" + key({k, j, i}, "/"), encode(chunks.bytes<Sample>(k, j, i)));
  });
}

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
std::string zstd(const std::string& data) {
  std::string out(ZSTD_compressBound(data.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), data.data(), data.size(), 3));
  return out;
}

TEST(Zarr2, Zstd) {
  const TempFolder folder;
  put_zarr2(folder / "a", {{"compressor", {{"id", "zstd"}}}}, {}, zstd);
  EXPECT_EQ(read_file<std::int16_t>(folder / "a"), kExpected);
  put_file(folder / "a/0.0.0", zstd(std::string(25, 'x')));
  EXPECT_TRUE(contains(refusal(folder / "a"), "0.0.0: expected at most 24 bytes in zstd"));
}
#endif

#ifdef ISOWEAVE_HAS_BLOSC
std::string blosc(const std::string& data) {
  std::string out(data.size() + BLOSC_MAX_OVERHEAD, '\0');
  const int bytes =
      blosc_compress_ctx(5, BLOSC_SHUFFLE, 2, data.size(), data.data(), out.data(), out.size(), "lz4", 0, 1);
  out.resize(static_cast<std::size_t>(bytes));
  return out;
}

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
std::string lz4(const std::string& data) {
  std::string out(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(data.size()))), '\0');
  const int bytes =
      LZ4_compress_default(data.data(), out.data(), static_cast<int>(data.size()), static_cast<int>(out.size()));
  out.resize(static_cast<std::size_t>(bytes));
  return bytes_of(static_cast<std::uint32_t>(data.size())) + out;
}

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
  EXPECT_TRUE(contains(refused({{"dtype", "<u8"}}), ".zarray: expected a dtype of integers of 8, 16 or 32 bits"));
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
  EXPECT_TRUE(contains(refusal(folder / "a"), "0.0.0: expected at most 4120 bytes for a chunk of 24, found 9000"));
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

std::string with_sum(const std::string& data) { return data + bytes_of(crc32c(std::as_bytes(std::span(data)))); }

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

// Shards of 1 x 2 x 2 chunks; the last chunk of each is left out.
void put_shards(const std::string& folder, bool at_end) {
  const ArrayJson index = {kZarr3["codecs"][0], {{"name", "crc32c"}}};
  const ArrayJson sharding = {{"chunk_shape", {2, 3, 2}},
                              {"codecs", kZarr3["codecs"]},
                              {"index_codecs", index},
                              {"index_location", at_end ? "end" : "start"}};
  ArrayJson metadata = kZarr3;
  metadata["fill_value"] = 9;
  metadata["chunk_grid"]["configuration"]["chunk_shape"] = {2, 6, 4};
  metadata["codecs"] = {{{"name", "sharding_indexed"}, {"configuration", sharding}}};
  put_json(folder + "/zarr.json", metadata);
  const ChunkOf chunks;
  for (std::int64_t k = 0; k < 2; ++k) {
    for (std::int64_t i = 0; i < 2; ++i) {
      const std::uint64_t begin = at_end ? 0 : 4 * 16 + 4;
      std::string data, places;
      for (std::int64_t n = 0; n < 4; ++n) {
        const bool there = n < 3;
        const std::string chunk = chunks.bytes<std::int16_t>(k, n / 2, 2 * i + n % 2);
        places += bytes_of(there ? begin + data.size() : ~std::uint64_t{0});
        places += bytes_of(there ? std::uint64_t{chunk.size()} : ~std::uint64_t{0});
        if (there) data += chunk;
      }
      put_file(folder + "/c/" + key({k, 0, i}, "/"), at_end ? data + with_sum(places) : with_sum(places) + data);
    }
  }
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
  EXPECT_TRUE(contains(refused({{"data_type", "uint64"}}), "found 'uint64'"));
  EXPECT_TRUE(contains(refused({{"chunk_grid", {{"name", "rectangular"}}}}), "found 'rectangular'"));
  EXPECT_TRUE(contains(refused({{"chunk_key_encoding", {{"name", "hash"}}}}), "found 'hash'"));
  EXPECT_TRUE(contains(refused({{"node_type", "table"}}), "expected node_type array or group"));
  EXPECT_TRUE(contains(refused({{"storage_transformers", {1}}}), "storage_transformers"));
  const ArrayJson turned = {{{"name", "transpose"}, {"configuration", {{"order", {0, 1, 1}}}}}, bytes};
  EXPECT_TRUE(contains(refused({{"codecs", turned}}), "an order of all axes"));
}

}  // namespace
}  // namespace isoweave::testing
