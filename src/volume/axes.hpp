// Turns what a header says about axes into a Geometry, or refuses it.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "isoweave/volume.hpp"

namespace isoweave {

using Vector3 = std::array<double, 3>;

// Axes as headers give them: steps[a] is the world vector from one sample to the next along axis a.
struct Axes {
  std::array<Vector3, 3> steps{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Vector3 origin{0, 0, 0};
};

// The length of a vector. It is scaled by a power of two, so that squares neither vanish nor overflow, and no formula
// of a standard library is used. Infinite or NaN where a component is.
double length_of(const Vector3& v);

// Splits steps into spacing (their lengths) and unit directions. Throws BadInput naming `path` when a number is not
// finite, a step has no length, or the axes do not span space. Mirrored axes (negative determinant) are kept.
// source: of the steps, where a header may have several, such as " by the sform"
void set_geometry(Geometry& geometry, const Axes& axes, std::string_view path, const std::string& source = {});

// A unit vector orthogonal to `a` and `b`: the missing third axis of a plane image.
Vector3 normal_of(const Vector3& a, const Vector3& b);

// Throws std::invalid_argument unless all steps that a caller names are usable: neither too short nor too long for
// areas and volumes to be computed.
void require_usable_steps(const std::array<double, 3>& spacing);

// Throws std::invalid_argument, naming the path, unless steps are usable, the other numbers are finite, and samples
// have a slope. A volume opened from a file is usable; a caller's own source may not be.
void require_usable(const VolumeInfo& volume);

// Cube root by Newton's method: additions, multiplications and divisions only, so equal on every machine.
double cube_root(double x);

// Mean side of a voxel.
double mean_voxel(const Geometry& geometry);

// Applies the caller's overrides. Throws std::invalid_argument when they are not usable.
void apply_overrides(VolumeInfo& volume, const OpenOptions& options);

}  // namespace isoweave
