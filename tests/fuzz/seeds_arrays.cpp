// Seeds that are folders of arrays. The names are those that CMakeLists.txt gives the targets; a file that a seed does
// not have is empty there, or missing where all behind it are.
#include <functional>
#include <initializer_list>
#include <vector>

#include "seeds.hpp"
#include "zarr_helpers.hpp"

namespace isoweave::fuzz {
namespace {

using namespace testing;
using namespace testing::zarr_files;

class ArraySeeds {
 public:
  ArraySeeds(Seeds& seeds, std::string target, std::vector<std::string> names)
      : seeds_(seeds), target_(std::move(target)), names_(std::move(names)) {}

  // `write` is given a folder to write the array into.
  void put(const std::function<void(const std::string&)>& write) {
    const TempFolder folder;
    write(folder / "a");
    std::string text, between;
    for (const std::string& name : names_) {
      const std::string path = folder / ("a/" + name);
      if (std::filesystem::is_regular_file(path)) text += std::exchange(between, {}) + get(path);
      between += kNext;
    }
    seeds_.put(target_, text);
  }

 private:
  Seeds& seeds_;
  std::string target_;
  std::vector<std::string> names_;
};

void put_zarr2_seeds(Seeds& all) {
  ArraySeeds seeds(all, "zarr2", {".zarray", ".zattrs", "0.0.0", "0.0.1", "0/0/0", "0/0/1"});
  const auto put = [&seeds](const ArrayJson& changes, const ChunkOf& chunks = {}, const Encode& encode = plain) {
    seeds.put([&](const std::string& folder) {
      put_zarr2(folder, changes, chunks, encode);
      put_json(folder + "/.zattrs", ArrayJson::object());
    });
  };
  put({{"fill_value", -7}});
  put({{"order", "F"}, {"dtype", ">i2"}, {"dimension_separator", "/"}}, {.big = true, .fortran = true});
  put({{"compressor", {{"id", "gzip"}}}}, {}, gzipped);
  put({{"compressor", {{"id", "zlib"}, {"level", 1}}}}, {}, zlibbed);
#ifdef ISOWEAVE_HAS_ZSTD
  put({{"compressor", {{"id", "zstd"}}}}, {}, zstd);
#endif
#ifdef ISOWEAVE_HAS_BLOSC
  put({{"compressor", {{"id", "blosc"}, {"cname", "lz4"}}}}, {}, blosc);
#endif
#ifdef ISOWEAVE_HAS_LZ4
  put({{"compressor", {{"id", "lz4"}}}}, {}, lz4);
#endif
  seeds.put([](const std::string& folder) {
    put_zarr2<float>(folder, {{"dtype", "<f4"}, {"fill_value", "NaN"}});
    put_json(folder + "/.zattrs", {{"_ARRAY_DIMENSIONS", {"z", "y", "x"}},
                                   {"resolution", {40, 4, 8}},
                                   {"offset", {400, 0, 80}},
                                   {"units", {"nm", "nm", "nm"}}});
  });
}

void put_zarr3_seeds(Seeds& all) {
  ArraySeeds seeds(all, "zarr3", {"zarr.json", "c/0/0/0", "c/0/0/1", "c/1/0/0", "c.0.0.0", "0.0.0"});
  const ArrayJson bytes = kZarr3["codecs"][0];
  const auto put = [&seeds](const ArrayJson& changes, const ChunkOf& chunks = {}, const Encode& encode = plain) {
    seeds.put([&](const std::string& folder) { put_zarr3(folder, changes, chunks, encode); });
  };
  put({{"dimension_names", {"z", "y", "x"}}, {"attributes", {{"resolution", {3, 2, 1}}, {"unit", "um"}}}});
  put({{"codecs",
        {{{"name", "transpose"}, {"configuration", {{"order", {2, 1, 0}}}}},
         {{"name", "bytes"}, {"configuration", {{"endian", "big"}}}}}}},
      {.big = true, .fortran = true});
  put({{"codecs", {bytes, {{"name", "gzip"}}, {{"name", "crc32c"}}}}}, {},
      [](const std::string& data) { return with_sum(gzipped(data)); });
#ifdef ISOWEAVE_HAS_ZSTD
  put({{"codecs", {bytes, {{"name", "zstd"}}}}}, {}, zstd);
#endif
#ifdef ISOWEAVE_HAS_BLOSC
  put({{"codecs", {bytes, {{"name", "blosc"}}}}}, {}, blosc);
#endif
  for (const bool at_end : {true, false}) {
    seeds.put([at_end](const std::string& folder) { put_shards(folder, at_end); });
  }
  seeds.put([](const std::string& folder) {
    put_zarr3(folder, {{"chunk_key_encoding", {{"name", "v2"}}}, {"fill_value", "0x0007"}});
    put_file(folder + "/0.0.0", get(folder + "/c/0/0/0"));
    std::filesystem::remove_all(folder + "/c");
  });
}

void put_ome_zarr_seeds(Seeds& all) {
  ArraySeeds seeds(all, "ome_zarr",
                   {".zattrs", "0/.zarray", "0/0.0.0", "0/0.0.0.0.0", "1/.zarray", "1/0.0.0", "zarr.json",
                    "0/zarr.json", "0/c/0/0/0"});
  const ArrayJson two = {level("0", list({scale({2, 0.5, 0.25})})),
                         level("1", {scale({4, 1, 0.5}), shift({1, 0.25, 0.125})})};
  seeds.put([&two](const std::string& folder) {
    put_group(folder, image(kAxes, two, {scale({10, 10, 10}), shift({100, 200, 300})}));
    put_array(folder + "/0", {4, 4, 6});
    put_array(folder + "/1", {2, 2, 3});
  });
  seeds.put([](const std::string& folder) {
    ArrayJson axes = {{{"name", "t"}, {"type", "time"}}, {{"name", "c"}, {"type", "channel"}}};
    axes.insert(axes.end(), kAxes.begin(), kAxes.end());
    put_group(folder, image(axes, list({level("0", list({scale({1, 1, 1, 1, 1})}))})));
    put_array(folder + "/0", {2, 3, 2, 2, 2});
  });
  seeds.put([](const std::string& folder) {
    put_group(folder, ArrayJson::object());
    put_array(folder + "/0", {2, 2, 2});
  });
  seeds.put([](const std::string& folder) {
    const ArrayJson attributes = {{"ome", image(kAxes, list({level("0", list({scale({3, 2, 1})}))}))}};
    put_json(folder + "/zarr.json", {{"zarr_format", 3}, {"node_type", "group"}, {"attributes", attributes}});
    put_zarr3(folder + "/0");
  });
}

void put_n5_seeds(Seeds& all) {
  ArraySeeds seeds(all, "n5",
                   {"attributes.json", "0/0/0", "1/0/0", "s0/attributes.json", "s0/0/0/0", "s1/attributes.json"});
  const auto put = [&seeds](const std::string& compression, const ArrayJson& changes, const Encode& encode) {
    seeds.put([&](const std::string& folder) { put_n5(folder, compression, changes, encode); });
  };
  put("raw", {{"resolution", {1, 2, 3}}, {"units", {"um", "um", "um"}}, {"offset", {10, 20, 30}}}, plain);
  put("gzip", {{"axes", {"x", "y", "z"}}}, gzipped);
#ifdef ISOWEAVE_HAS_ZSTD
  put("zstd", {}, zstd);
#endif
#ifdef ISOWEAVE_HAS_BLOSC
  put("blosc", {}, blosc);
#endif
#ifdef ISOWEAVE_HAS_LZ4
  put("lz4", {}, [](const std::string& data) {
    const std::string sizes =
        bytes_of(static_cast<std::uint32_t>(data.size())) + bytes_of(static_cast<std::uint32_t>(data.size()));
    return "LZ4Block\x10" + sizes + std::string(4, '\0') + data + "LZ4Block\x10" + std::string(12, '\0');
  });
#endif
  seeds.put([](const std::string& folder) {
    put_json(folder + "/attributes.json", {{"pixelResolution", {{"dimensions", {4, 4, 40}}, {"unit", "nm"}}}});
    put_n5(folder + "/s0", "raw");
    put_n5(folder + "/s1", "raw", {{"downsamplingFactors", {2, 2, 1}}});
  });
}

ArrayJson precomputed_info(const char* type, const char* encoding) {
  const ArrayJson scale = {{"key", "k"},
                           {"size", {4, 3, 2}},
                           {"resolution", {4, 4, 40}},
                           {"voxel_offset", {0, 0, 0}},
                           {"chunk_sizes", {{2, 3, 2}}},
                           {"encoding", encoding},
                           {"compressed_segmentation_block_size", {2, 2, 2}}};
  return {{"data_type", type}, {"num_channels", 1}, {"scales", {scale}}};
}

// Numbers as they are stored.
template <class Word>
std::string words(std::initializer_list<Word> numbers) {
  std::string text;
  for (const Word number : numbers) text += bytes_of(number);
  return text;
}

void put_precomputed_seeds(Seeds& all) {
  ArraySeeds seeds(all, "precomputed", {"info", "k/0-2_0-3_0-2", "k/2-4_0-3_0-2", "k/0.shard", "k/1.shard"});
  const std::string raw = words<std::uint16_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  seeds.put([&](const std::string& folder) {
    put_json(folder + "/info", precomputed_info("uint16", "raw"));
    put_file(folder + "/k/0-2_0-3_0-2", raw);
    put_file(folder + "/k/2-4_0-3_0-2", raw);
  });
  // Two blocks: one of two labels, one bit for each sample; one of a single label.
  seeds.put([&](const std::string& folder) {
    put_json(folder + "/info", precomputed_info("uint32", "compressed_segmentation"));
    put_file(folder + "/k/0-2_0-3_0-2", words<std::uint32_t>({1, 5 | 1U << 24, 4, 6, 7, 0xa5, 3, 9}));
  });
  // A shard of one minishard, in which the second chunk lies.
  seeds.put([&](const std::string& folder) {
    ArrayJson info = precomputed_info("uint16", "raw");
    info["scales"][0]["sharding"] = {{"@type", "neuroglancer_uint64_sharded_v1"},
                                     {"hash", "identity"},
                                     {"preshift_bits", 0},
                                     {"minishard_bits", 0},
                                     {"shard_bits", 1}};
    put_json(folder + "/info", info);
    put_file(folder + "/k/1.shard", words<std::uint64_t>({24, 48}) + raw + words<std::uint64_t>({1, 0, 24}));
  });
}

}  // namespace

void put_arrays(Seeds& seeds) {
  put_zarr2_seeds(seeds);
  put_zarr3_seeds(seeds);
  put_ome_zarr_seeds(seeds);
  put_n5_seeds(seeds);
  put_precomputed_seeds(seeds);
}

}  // namespace isoweave::fuzz
