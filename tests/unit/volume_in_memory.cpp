// Volumes whose samples are in memory already.
// Threads: none, surfaces.cpp has the same runs
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include "../surfaces.hpp"

namespace isoweave::testing::volume_in_memory_test {
namespace {

VolumeInfo info_of(std::array<std::int64_t, 3> dims, SampleType type) {
  VolumeInfo info;
  info.path = "memory";
  info.dims = dims;
  info.type = type;
  return info;
}

TEST(VolumeInMemory, IsHeldAndReadAlike) {
  std::vector<std::int16_t> samples(2 * 3 * 4);
  std::iota(samples.begin(), samples.end(), std::int16_t{-5});
  const auto volume = volume_in_memory(info_of({2, 3, 4}, SampleType::kInt16), std::as_bytes(std::span(samples)));
  EXPECT_EQ(volume->held().data(), reinterpret_cast<const std::byte*>(samples.data()));
  EXPECT_EQ(volume->held().size(), 48u);
  std::vector<std::int16_t> two(12);
  volume->read(1, 2, std::as_writable_bytes(std::span(two)));
  EXPECT_EQ(two, std::vector<std::int16_t>(samples.begin() + 6, samples.begin() + 18));
  EXPECT_THROW(volume->read(2, 1, std::as_writable_bytes(std::span(two))), std::invalid_argument) << "behind";
  EXPECT_THROW(volume->read(3, 2, std::as_writable_bytes(std::span(two))), std::invalid_argument) << "outside";
}

TEST(VolumeInMemory, OtherNumbersOfSamplesAreRefused) {
  const std::vector<std::int16_t> samples(24);
  const auto bytes = std::as_bytes(std::span(samples));
  const auto refused = [&](std::array<std::int64_t, 3> dims, std::span<const std::byte> held) {
    EXPECT_THROW(volume_in_memory(info_of(dims, SampleType::kInt16), held), std::invalid_argument)
        << dims[0] << " x " << dims[1] << " x " << dims[2] << ", " << held.size() << " bytes";
  };
  refused({2, 3, 5}, bytes);
  refused({2, 3, 3}, bytes);
  refused({2, 3, 2}, bytes);
  refused({2, 3, 0}, bytes);
  refused({-2, -3, 4}, bytes);
  refused({2, 3, 4}, bytes.first(47));
  refused({2, 3, 4}, {});
  refused({0, 0, 0}, {});
  refused({std::int64_t{1} << 62, std::int64_t{1} << 62, 24}, bytes);
  refused({2, 3, 3}, bytes.subspan(1, 36));
}

// A surface by slices that are read, and by the samples where they are.
TEST(VolumeInMemory, GivesTheSameSurface) {
  GenerateOptions generate;
  generate.kind = "noise";
  generate.dims = {37, 29, 23};
  generate.type = SampleType::kFloat32;
  std::vector<float> samples(37 * 29 * 23);
  generate_volume(generate)->read(0, 23, std::as_writable_bytes(std::span(samples)));
  MemoryVolume read(generate.dims, samples);
  const auto digest = [](SliceSource& volume, const MeshOptions& options, std::int64_t slab, int threads) {
    MemorySink sink;
    RunControl control;
    control.threads = threads;
    control.slab = slab;
    const MeshReport report = mesh_volume(volume, sink, options, control);
    EXPECT_GT(report.triangles, 1000u);
    return report.digest + riders_digest(sink.mesh);
  };
  for (const int smooth : {0, 2}) {
    for (const Normals normals : {Normals::kAbsent, Normals::kGradient}) {
      for (const std::int64_t slab : {0, 1, 5}) {
        MeshOptions options;
        options.iso = suggested_iso("noise", SampleType::kFloat32);
        options.error = Length::voxels(0.3);
        options.normals = normals;
        options.smooth = smooth;
        MemoryVolume read_again(generate.dims, samples);
        const auto held = volume_in_memory(read.info(), std::as_bytes(std::span(std::as_const(samples))));
        EXPECT_EQ(digest(*held, options, slab, 4), digest(read_again, options, slab, 1))
            << "slab " << slab << ", smooth " << smooth;
      }
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_in_memory_test
