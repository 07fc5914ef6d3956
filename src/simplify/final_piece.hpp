// The hand-over of final triangles: what leaves a zone, on processors and on a device, and what its receiver tells the
// zone in return.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "isoweave/mesh.hpp"
#include "lattice/vec3.hpp"
#include "parallel/array.hpp"

namespace isoweave {

inline constexpr std::uint64_t kNotHandedOver = ~std::uint64_t{0};

// The receiver's name for a vertex. The zone keeps it for as long as it holds the vertex, and gives it back with later
// triangles. It has no other meaning there.
struct Receipt {
  std::uint64_t number = kNotHandedOver;
  std::uint32_t label = 0;
};

// A vertex that an earlier piece has handed over.
struct KnownVertex {
  Vec3 position;
  Receipt receipt;
};

// Triangles that have become final. They name the known vertices first, then the new ones.
struct FinalPiece {
  Array<KnownVertex> known;
  Array<Vec3> positions;  // of new vertices, physical lengths
  Array<Point> normals;   // of new vertices: sums of unit normals; or none
  Array<float> values;    // of new vertices; or none
  Array<std::array<std::uint32_t, 3>> triangles;
  Array<std::uint8_t> locked;    // per vertex: 1 if it is locked; or none, where no vertex of the surface is
  std::uint64_t open_edges = 0;  // edges of one triangle, without those that have a locked end
};

// The seam between what simplifies and what writes.
class FinalSource {
 public:
  FinalSource() = default;
  FinalSource(const FinalSource&) = delete;
  FinalSource& operator=(const FinalSource&) = delete;
  virtual ~FinalSource() = default;

  // Fills in triangles that have become final, each once. The new vertices get consecutive numbers and labels from
  // `first` on as their receipts.
  virtual void take_final(const Receipt& first, FinalPiece& piece) = 0;

  // Whether take_final() has left some for another call, as they are many.
  virtual bool has_more() const { return false; }

  virtual std::size_t held_vertices() const = 0;

  // Lets the receiver replace the labels in the receipts that are held.
  virtual void change_labels(const std::function<void(std::span<std::uint32_t*>)>& change) = 0;
};

}  // namespace isoweave
