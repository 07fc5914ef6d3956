// How a surface is simplified: the same options for volumes and for meshes.
#pragma once

#include <cstdint>
#include <vector>

#include "isoweave/length.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// How much the cost of an edge is refined when the edge is decided. Each quality gives one mesh, whatever the schedule.
//   fast    accumulated quadrics alone
//   normal  the current faces count more, and placement preserves volume; an edge dearer than twice its key goes back
//   fine    the same with lower keys; an edge a tenth dearer than its key goes back: lowest error
enum class Quality : std::uint8_t { kFast, kNormal, kFine };

struct SimplifyOptions {
  Length error = Length::voxels(0.2);  // root of the largest quadric error of a collapse; 0: no simplification
  // No point of the result is farther than this from the surface before simplification; 0: no such guarantee. Points of
  // that surface may be farther from the result. Costs time, and memory for that surface around the undecided zone. The
  // error may be infinite then, for the fewest triangles within the distance: it stands for 64 times the distance.
  Length max_distance{};
  // Stop at the first collapse that leaves no more triangles than this, unless the error stops the run before; 0: no
  // such number. The error may be infinite then. Each closed component keeps 4 triangles, so the number may be out of
  // reach, and going on would ruin shapes: most_shape_error() is a bound. Between two slabs a quarter more triangles
  // than the number and 50,000 are held, or as many as it takes to be sure of the result.
  std::uint64_t triangles = 0;
  // In place of a number: this share of the triangles that the surface has before simplification, above 0 and up to 1;
  // 0: no share. The number is the nearest one, and at least 1. It is known when the surface is complete, so until then
  // all triangles are held that a head start (RunControl::head_start) does not let go. Without a head start they are
  // counted in a pass before, where the volume can be opened again (RunControl::reopen).
  double share = 0;
  Quality quality = Quality::kNormal;
  // A closed component that has shrunk to a tetrahedron is dropped when half its longest edge is no longer than the
  // error. Without this option every component stays, and topology with it.
  bool drop_specks = false;
  // Errors of finer meshes from the same sweep, ascending, all below `error`. Each mesh is that of a run with that
  // error. At most 255; not with a number of triangles.
  std::vector<Length> levels{};
};

}  // namespace isoweave
#pragma GCC visibility pop
