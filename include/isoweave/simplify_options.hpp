// How a surface is simplified: the same options for volumes and for meshes.
#pragma once

#include <cstdint>
#include <vector>

#include "isoweave/length.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// How much an edge's cost is refined when it is decided. Every quality gives one mesh, whatever the schedule.
//   fast    accumulated quadrics alone
//   normal  the current faces count more, placement preserves volume; an edge dearer than twice its key goes back
//   fine    the same with lower keys, and an edge a tenth dearer than its key goes back: lowest error
enum class Quality : std::uint8_t { kFast, kNormal, kFine };

struct SimplifyOptions {
  Length error = Length::voxels(0.2);  // root of the largest quadric error of a collapse; 0: no simplification
  // No point of the result is farther than this from the surface before it was simplified; 0: no such guarantee. The
  // other way round nothing is promised. Costs time, and memory for that surface around what is undecided.
  Length max_distance{};
  // Stop at the first collapse that leaves no more triangles than this, if the error does not stop it before; 0: no
  // such number. The error may be infinite then, and shapes be lost where the number is out of reach, as each closed
  // component keeps 4 triangles: most_shape_error() is a bound. Between two slabs a quarter more triangles than that
  // and 50,000 are held, or as many as it takes to be sure of the result.
  std::uint64_t triangles = 0;
  Quality quality = Quality::kNormal;
  // A closed component that has shrunk to a tetrahedron goes when half its longest edge is no longer than the error.
  // Else every component stays, and topology with it.
  bool drop_specks = false;
  // Errors of finer meshes that come out of the same sweep, ascending, all below `error`; each is the mesh of a run
  // with that error. Not with a number of triangles.
  std::vector<Length> levels{};
};

}  // namespace isoweave
#pragma GCC visibility pop
