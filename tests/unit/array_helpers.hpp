// Folders of chunked arrays, written by hand for the tests.
#pragma once

#include <nlohmann/json.hpp>

#include "volume_helpers.hpp"

namespace isoweave::testing {

using ArrayJson = nlohmann::json;

// Writes a file, and the folders it lies in.
inline void put_file(const std::string& path, const std::string& content) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << content;
}

inline void put_json(const std::string& path, const ArrayJson& json) { put_file(path, json.dump()); }

// Sample (k, j, i) of every volume here; differs everywhere and from its byte-swapped self.
inline std::int64_t sample_at(std::int64_t k, std::int64_t j, std::int64_t i) { return 1 + i + 17 * j + 131 * k; }

template <class Sample>
std::vector<Sample> expected_samples(const std::array<std::int64_t, 3>& dims) {
  std::vector<Sample> samples;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) samples.push_back(static_cast<Sample>(sample_at(k, j, i)));
    }
  }
  return samples;
}

// The samples of one chunk, as a writer lays them out.
struct ChunkOf {
  std::array<std::int64_t, 3> dims{5, 4, 3};   // i, j, k
  std::array<std::int64_t, 3> chunk{2, 3, 2};  // i, j, k
  bool big = false;
  bool fortran = false;  // k fastest
  bool cut = false;      // at the end of the array

  template <class Sample>
  std::string bytes(std::int64_t ck, std::int64_t cj, std::int64_t ci) const {
    const std::array<std::int64_t, 3> first{ci * chunk[0], cj * chunk[1], ck * chunk[2]};
    std::array<std::int64_t, 3> size = chunk;
    for (std::size_t a = 0; a < 3 && cut; ++a) size.at(a) = std::min(chunk.at(a), dims.at(a) - first.at(a));
    std::string text;
    for (std::int64_t slow = 0; slow < size[fortran ? 0 : 2]; ++slow) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        for (std::int64_t fast = 0; fast < size[fortran ? 2 : 0]; ++fast) {
          const std::int64_t i = first[0] + (fortran ? slow : fast), k = first[2] + (fortran ? fast : slow);
          text += bytes_of(static_cast<Sample>(sample_at(k, first[1] + j, i)), big);
        }
      }
    }
    return text;
  }
};

// Calls visit(ck, cj, ci) for every chunk of the grid.
template <class Visit>
void for_chunks(const ChunkOf& array, Visit&& visit) {
  const auto count = [&array](std::size_t a) { return (array.dims.at(a) + array.chunk.at(a) - 1) / array.chunk.at(a); };
  for (std::int64_t ck = 0; ck < count(2); ++ck) {
    for (std::int64_t cj = 0; cj < count(1); ++cj) {
      for (std::int64_t ci = 0; ci < count(0); ++ci) visit(ck, cj, ci);
    }
  }
}

inline std::string key(const std::vector<std::int64_t>& index, const std::string& separator) {
  std::string text;
  for (const std::int64_t n : index) text += (text.empty() ? "" : separator) + std::to_string(n);
  return text;
}

}  // namespace isoweave::testing
