// The size and place of a mesh in its file, for programs that print or assemble it: scaled, centred, on the plate.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

struct MeshPlacing {
  double scale = 1;     // > 0: of all coordinates, first of all
  bool center = false;  // the middle of the mesh's box comes to the origin
  bool ground = false;  // the lowest point comes to z = 0, also with `center`

  bool given() const { return scale != 1 || center || ground; }
};

// The number of units `to` in one unit `from`, for MeshPlacing::scale. No unit is millimetres.
// @throws std::invalid_argument for a unit that is not known
double unit_ratio(const std::string& from, const std::string& to);

// The offset that the placed mesh has in its file (MeshFileOptions::offset), from that of the mesh as it comes.
std::array<double, 3> placed_offset(const std::array<double, 3>& offset, const MeshPlacing& placing);

// Keeps a mesh until it is finished, and hands it to another sink at its new size and place. Coordinates are computed
// in 64 bits and rounded once to 32.
// @pre The other sink has the offset that placed_offset() gives.
// @throws std::invalid_argument for a scale that is not positive and finite
// @cost Holds the mesh in memory: 12 bytes for each vertex, normal and triangle, 4 for each value.
class PlacedSink final : public MeshSink {
 public:
  // offset: of the mesh as it comes. normals, values: whether the other sink takes them.
  PlacedSink(std::unique_ptr<MeshSink> sink, const std::array<double, 3>& offset, const MeshPlacing& placing);

  void append(const MeshPiece& piece) override { mesh_.append(piece); }
  bool has_room() const override { return true; }
  MeshRoom room(const MeshPieceSize& size) override { return mesh_.room(size); }
  void finish() override;
  std::vector<std::string> notes() const override { return sink_->notes(); }
  std::array<double, 3> offset() const override { return mesh_.offset(); }

  // The digest of the mesh at its new place, once it is finished.
  std::uint64_t digest() const { return digest_; }

 private:
  std::unique_ptr<MeshSink> sink_;
  MeshInMemory mesh_;
  MeshPlacing placing_;
  std::uint64_t digest_ = 0;
};

}  // namespace isoweave
#pragma GCC visibility pop
