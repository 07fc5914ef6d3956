// Points, polygons and strips of VTK as a mesh, whichever kind of file they come from.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_leftovers.hpp"
#include "mesh/read/mesh_place.hpp"
#include "mesh/read/polygons.hpp"
#include "mesh/read/vtk_numbers.hpp"

namespace isoweave::mesh_io {

inline constexpr std::string_view kPointCells = "cells that are points";
inline constexpr std::string_view kLineCells = "lines";
inline constexpr std::string_view kGhostCells = "ghost cells";

// All failures are BadInput of the input.
class VtkMesh {
 public:
  explicit VtkMesh(const MeshInput& input) : input_(input) {}

  // Adds the points of a further piece; later indices count from its first point. `narrow`: the points are floats of 32
  // bits.
  void add_points(VtkNumbers& numbers, std::uint64_t count, bool narrow);

  // A number or a direction for each point of the piece.
  void add_normals(VtkNumbers& numbers);
  void add_values(VtkNumbers& numbers);

  // A cell, by the numbers of its points.
  void add_polygon(std::span<const std::uint64_t> corners);
  void add_strip(std::span<const std::uint64_t> corners);

  // Adds a cell of one of VTK's kinds, by its number. Fails for kinds that are no surface.
  void add_cell(std::uint64_t kind, std::span<const std::uint64_t> corners);

  // The number of points of this piece.
  std::uint64_t points() const { return points_; }

  TriangleMesh finish(const MeshPlace& place);

  MeshLeftovers leftovers;

 private:
  std::uint32_t checked(std::uint64_t corner) const;
  void widen();

  const MeshInput& input_;
  TriangleMesh mesh_;
  Polygons polygons_{mesh_};
  std::vector<WidePoint> wide_;  // all points, when some are not floats of 32 bits
  bool is_wide_ = false;
  std::uint64_t before_ = 0, points_ = 0;  // of the pieces before, and of this one
  std::uint64_t pieces_ = 0;
};

}  // namespace isoweave::mesh_io
