// Volumes made from formulas, of any size, computed slice by slice when they are read.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Kinds and the surface they hold at their suggested iso-value:
//   sphere   signed distance in samples, positive inside: one sphere of radius 0.4 of the smallest side
//   torus    one torus around the slowest axis
//   gyroid   sin x cos y + sin y cos z + sin z cos x, period 32 samples: many tunnels, the same texture everywhere
//   box      an axis-aligned box, shifted off the lattice: large flats, sharp edges
//   shells   thin concentric spheres, two samples apart
//   smooth   value noise on a coarse lattice: blobs without flats
//   noise    smooth noise plus a weaker white noise: what CT looks like
//   white    independent samples: the hardest topology there is
//   specks   isolated single inside samples
struct GenerateOptions {
  std::string kind = "sphere";
  std::array<std::int64_t, 3> dims{64, 64, 64};
  SampleType type = SampleType::kFloat32;  // integers hold the formula mapped to 0...255 (int8: -128...127)
  std::array<double, 3> spacing{1, 1, 1};
  std::uint64_t seed = 1;
};

// All kinds, in the order above.
std::vector<std::string> generator_kinds();

// The iso-value at which a kind shows the surface described above, in the units of the samples of `type`.
// @throws std::invalid_argument for an unknown kind
double suggested_iso(std::string_view kind, SampleType type);

// A source of the volume. Nothing is computed before it is read.
// @throws std::invalid_argument for an unknown kind, dims < 1, more samples than 63 bits count, or spacing that is not
//   positive and finite
// @cost Memory: one row of float64, and what the kind needs for a slice; never the volume.
// @determinism Every sample is a pure function of (kind, dims, seed, i, j, k), the same on every machine.
std::unique_ptr<SliceSource> generate_volume(const GenerateOptions& options);

// Writes any source as NRRD (.nrrd, raw encoding, attached), MetaImage (.mha) or raw (.raw), by the ending of the name.
// The file is complete or absent: it is streamed under a temporary name and renamed when complete. A file of that name
// is replaced.
// @throws CannotWrite for another ending, a volume with a slope or intercept (but to .raw), and where the file cannot
//   be written; and what the source throws
// @cost Memory: slices of 4 MB in all, one at least.
void write_volume(SliceSource& source, const std::string& path);

}  // namespace isoweave
#pragma GCC visibility pop
