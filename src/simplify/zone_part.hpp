// A part of the undecided surface by itself: what a zone hands to a later run, or to another zone.
//
// Everything in a part goes by ids. So a surface makes the same part, byte by byte but for receipts, whatever held it:
// pieces of any size, any number of threads, processors or a device. A state file has lists of numbers, one for each
// field:
//
//   vertices by ascending ids: ids; positions; quadrics; whether each is final; numbers and labels of the receipts;
//     normals, quadrics of normals, values, where the run has them; for each finer level whether final, numbers, labels
//   triangles, each from its vertex with the smallest id on, ascending by the first two vertices: vertices; keys and
//     lower halves of the ties of the three sides; the sides beside which a triangle has been handed over, as bits; the
//     number of levels that have the triangle, and the bound of its distance
//   the front
//
// Twins, the starts of fans and turns are no part of it: who takes a part in finds them by ids.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "files/state_file.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

// The facts about a vertex in the mesh of a level before the last one.
struct LevelVertex {
  std::uint64_t number = kNotHandedOver;  // with the label, its receipt
  std::uint32_t label = 0;
  bool final = false;  // no edge has a key within the level's error
};

// The arrays of a zone that holds a part, linked. Turns are unknown.
struct ZonePart {
  Array<Vertex> vertices;
  Array<VertexState> states;
  std::vector<Point> normals;
  Array<NormalQuadric> normal_quadrics;
  std::vector<float> values;
  Array<Triangle> triangles;
  std::vector<Array<LevelVertex>> levels;  // before the last one
  std::vector<Index> front;                // incomplete vertices, in the order in which the next piece names them
  std::vector<Index> unkeyed_edges;        // an end is incomplete, or has been
  std::vector<Index> completed;            // vertices that have got the last of their triangles, and have no quadrics

  // Its arrays as a zone, without options and levels.
  ZoneView view();
};

// The properties that a part must have to belong to a run.
struct PartShape {
  bool normals = false, normal_quadrics = false, values = false;
  CostBits retire = 0;
  std::uint64_t end_id = 0;   // ids are smaller
  Vec3 farthest{};            // limits of positions, along each axis
  std::vector<Receipt> ends;  // of each level, the last one included: receipts have smaller numbers and labels
};

// Writes the part that a zone holds, where no vertex is locked. Memory: 24 bytes for each vertex, or 12 and 4 for each
// triangle.
void write_part(StateWriter& state, const ZoneView& zone, std::span<const Array<LevelVertex>> levels,
                std::span<const Index> front);

// Writes a part that is not linked.
void write_part(StateWriter& state, ZonePart& part);

// Reads a part without linking it: one of a surface that is cut. Throws BadInput when it is not of that shape.
ZonePart read_cut_part(StateReader& state, const PartShape& shape);

// Reads a part, and links it. Throws BadInput when it is not one of that shape, or no part that a zone could hold.
// Memory besides the part: 12 bytes for each triangle, and 8 for each vertex.
ZonePart read_part(StateReader& state, const PartShape& shape);

}  // namespace isoweave
