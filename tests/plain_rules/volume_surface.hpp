// Surfaces to begin with: of a volume as the library extracts it, of a mesh as it is in a file.
#pragma once

#include "isoweave/pipeline.hpp"
#include "plain_rules/simplifier.hpp"

namespace isoweave::plain {

// A volume in memory, each sample as a double.
struct Samples {
  VolumeInfo info;
  std::vector<double> numbers;

  double at(const std::array<std::int64_t, 3>& index) const;  // not a number outside
};

Samples read_samples(SliceSource& volume);

// The surface that the library extracts where nothing is simplified, in coordinates of the index, on the volume's
// lattice. What a mesh does not tell, ids and places in 64 bits, follows from the lattice edge that each vertex lies on
// and the two samples there.
Surface surface_of(const Samples& volume, const TriangleMesh& extracted, const MeshOptions& options);

Surface surface_of(const TriangleMesh& mesh);

// Keeps the components that the rule says.
void keep(const ComponentRule& rule, Surface& surface);

}  // namespace isoweave::plain
