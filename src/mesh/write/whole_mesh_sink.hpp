// The writers that need the whole mesh at once: pieces wait in files, and come into memory when the mesh is finished.
#pragma once

#include "mesh/write/mesh_file_sink.hpp"
#include "parallel/size.hpp"

namespace isoweave {

class WholeMeshSink : public MeshFileSink {
 public:
  std::vector<std::string> notes() const final { return notes_; }

 protected:
  // `most_triangles`: that the format holds.
  WholeMeshSink(const MeshTarget& target, const MeshFileOptions& options, std::uint64_t most_triangles);

  virtual void write_mesh(TriangleMesh mesh) = 0;

  void note(std::string line) { notes_.push_back(std::move(line)); }

 private:
  void write_piece(const MeshPiece& piece) final;
  void complete() final;

  std::uint64_t most_triangles_;
  OutputDescriptor& positions_;
  OutputDescriptor& faces_;
  OutputDescriptor* normals_ = nullptr;
  std::vector<std::array<std::uint32_t, 3>> narrow_;
  std::vector<std::string> notes_;
};

// Reads a whole file of items into memory.
template <class Item>
std::vector<Item> read_all(OutputDescriptor& file, std::uint64_t count) {
  std::vector<Item> items(to_size(count));
  file.read_back(0, std::as_writable_bytes(std::span(items)));
  return items;
}

// A cube around a mesh in which coordinates are whole numbers of steps from 0 to 65535.
struct Grid16 {
  std::array<double, 3> origin{};
  double step = 1;

  static Grid16 around(std::span<const Point> points);

  std::array<std::uint16_t, 3> place(const Point& point) const;

  // The farthest that place() moves a point.
  double error() const;
};

// "positions were rounded to 1/65535 of the longest side: by at most 0.01 mm".
std::string rounding_note(const std::string& path, const Grid16& grid, const std::string& unit);

}  // namespace isoweave
