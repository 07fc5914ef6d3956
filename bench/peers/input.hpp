// What the contestants are given: a volume in memory, or a raw file of it.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "isoweave/volume.hpp"

namespace bench {

// Where a volume comes from: a file that isoweave reads, or "generate:KIND:WxHxD:TYPE".
struct VolumeName {
  std::string path;
  std::string raw;      // layout of a headerless file, or empty
  std::string spacing;  // "x,y,z" instead of the file's, or empty
};

std::unique_ptr<isoweave::SliceSource> open_source(const VolumeName& name);

// The iso-value of samples as they are stored.
double stored_iso(const isoweave::VolumeInfo& info, double iso);

// Edge of a cube as large as a voxel.
double mean_voxel(const isoweave::VolumeInfo& info);

struct HeldVolume {
  isoweave::VolumeInfo info;
  std::vector<std::byte> samples;
  double iso = 0;  // a value
};

HeldVolume hold(isoweave::SliceSource& source, double iso);

// Headerless samples in a file, so that reading costs everybody the same.
struct VolumeFile {
  isoweave::VolumeInfo info;  // of the file: its path, no slope
  double iso = 0;             // of samples as stored
};

VolumeFile write_raw(isoweave::SliceSource& source, double iso, const std::string& path);
std::unique_ptr<isoweave::SliceSource> open_source(const VolumeFile& file);

}  // namespace bench
