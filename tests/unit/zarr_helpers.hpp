// Arrays and images of Zarr 2, Zarr 3, OME-Zarr and N5, written by hand for the tests and for the fuzzer.
#pragma once

#include "array_helpers.hpp"
#include "volume/formats/chunked/chunk_codecs.hpp"

#ifdef ISOWEAVE_HAS_ZSTD
#include <zstd.h>
#endif
#ifdef ISOWEAVE_HAS_BLOSC
#include <blosc.h>
#endif
#ifdef ISOWEAVE_HAS_LZ4
#include <lz4.h>
#endif

namespace isoweave::testing::zarr_files {

using Encode = std::function<std::string(const std::string&)>;

inline std::string plain(const std::string& data) { return data; }

inline const ArrayJson kZarr2 = {{"zarr_format", 2},      {"shape", {3, 4, 5}}, {"chunks", {2, 3, 2}},
                                 {"dtype", "<i2"},        {"order", "C"},       {"fill_value", 0},
                                 {"compressor", nullptr}, {"filters", nullptr}};

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

inline const ArrayJson kZarr3 = {{"zarr_format", 3},
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

#ifdef ISOWEAVE_HAS_ZSTD
inline std::string zstd(const std::string& data) {
  std::string out(ZSTD_compressBound(data.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), data.data(), data.size(), 3));
  return out;
}
#endif

#ifdef ISOWEAVE_HAS_BLOSC
inline std::string blosc(const std::string& data) {
  std::string out(data.size() + BLOSC_MAX_OVERHEAD, '\0');
  const int bytes =
      blosc_compress_ctx(5, BLOSC_SHUFFLE, 2, data.size(), data.data(), out.data(), out.size(), "lz4", 0, 1);
  out.resize(static_cast<std::size_t>(bytes));
  return out;
}
#endif

#ifdef ISOWEAVE_HAS_LZ4
inline std::string lz4(const std::string& data) {
  std::string out(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(data.size()))), '\0');
  const int bytes =
      LZ4_compress_default(data.data(), out.data(), static_cast<int>(data.size()), static_cast<int>(out.size()));
  out.resize(static_cast<std::size_t>(bytes));
  return bytes_of(static_cast<std::uint32_t>(data.size())) + out;
}
#endif

inline std::string with_sum(const std::string& data) { return data + bytes_of(crc32c(std::as_bytes(std::span(data)))); }

// Shards of 1 x 2 x 2 chunks; the last chunk of each is left out.
inline void put_shards(const std::string& folder, bool at_end) {
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

// Blocks begin with their sizes, in numbers whose most significant byte comes first.
inline std::string n5_block(const ChunkOf& array, std::int64_t k, std::int64_t j, std::int64_t i) {
  std::string text = bytes_of(std::uint16_t{0}, true) + bytes_of(std::uint16_t{3}, true);
  const std::array<std::int64_t, 3> index{i, j, k};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t left = array.dims.at(a) - index.at(a) * array.chunk.at(a);
    text += bytes_of(static_cast<std::uint32_t>(std::min(left, array.chunk.at(a))), true);
  }
  return text;
}

inline void put_n5(const std::string& folder, const std::string& compression, const ArrayJson& attributes = {},
                   const Encode& encode = plain) {
  ArrayJson metadata = {{"dimensions", {5, 4, 3}},
                        {"blockSize", {2, 3, 2}},
                        {"dataType", "int16"},
                        {"compression", {{"type", compression}}}};
  if (!attributes.is_null()) metadata.update(attributes);
  put_json(folder + "/attributes.json", metadata);
  const ChunkOf chunks{.big = true, .cut = true};
  for_chunks(chunks, [&](std::int64_t k, std::int64_t j, std::int64_t i) {
    put_file(folder + "/" + key({i, j, k}, "/"),
             n5_block(chunks, k, j, i) + encode(chunks.bytes<std::int16_t>(k, j, i)));
  });
}

inline const ArrayJson kAxes = {{{"name", "z"}, {"type", "space"}, {"unit", "micrometer"}},
                                {{"name", "y"}, {"type", "space"}, {"unit", "micrometer"}},
                                {{"name", "x"}, {"type", "space"}, {"unit", "micrometer"}}};

// A list of one is not that one.
inline ArrayJson list(const std::vector<ArrayJson>& entries) { return entries; }

inline ArrayJson scale(const std::vector<double>& factors) { return {{"type", "scale"}, {"scale", factors}}; }
inline ArrayJson shift(const std::vector<double>& offsets) {
  return {{"type", "translation"}, {"translation", offsets}};
}

// An array of one chunk whose samples are 1, 2, 3, ...
inline void put_array(const std::string& folder, const std::vector<std::int64_t>& shape,
                      const ArrayJson& attributes = {}) {
  std::int64_t count = 1;
  for (const std::int64_t size : shape) count *= size;
  std::string samples;
  for (std::int64_t n = 1; n <= count; ++n) samples += bytes_of(static_cast<std::int16_t>(n));
  put_json(folder + "/.zarray", {{"zarr_format", 2},
                                 {"shape", shape},
                                 {"chunks", shape},
                                 {"dtype", "<i2"},
                                 {"order", "C"},
                                 {"fill_value", 0},
                                 {"compressor", nullptr},
                                 {"filters", nullptr}});
  put_file(folder + "/" + key(std::vector<std::int64_t>(shape.size(), 0), "."), samples);
  if (!attributes.is_null()) put_json(folder + "/.zattrs", attributes);
}

inline void put_group(const std::string& folder, const ArrayJson& attributes) {
  put_json(folder + "/.zgroup", {{"zarr_format", 2}});
  put_json(folder + "/.zattrs", attributes);
}

inline ArrayJson image(const ArrayJson& axes, const ArrayJson& datasets, const ArrayJson& whole = nullptr) {
  ArrayJson multiscale = {{"version", "0.4"}, {"axes", axes}, {"datasets", datasets}};
  if (!whole.is_null()) multiscale["coordinateTransformations"] = whole;
  return {{"multiscales", list({multiscale})}};
}

inline ArrayJson level(const std::string& path, const ArrayJson& transformations) {
  return {{"path", path}, {"coordinateTransformations", transformations}};
}

}  // namespace isoweave::testing::zarr_files
