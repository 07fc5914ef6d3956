// Triangle meshes held in memory, and files of them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace isoweave {

using Point = std::array<float, 3>;

// An indexed triangle mesh. 32-bit indices: at most 2^32 - 1 vertices, which read_mesh checks.
struct TriangleMesh {
  std::vector<Point> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<Point> normals;                           // one per vertex, or none
};

// Reads PLY (binary little- and big-endian, ascii; polygons are fanned), STL (binary, ascii; corners with
// equal coordinates become one vertex) or OBJ (v and f; polygons are fanned), told by content, then by name.
// Throws BadInput for anything missing, truncated, out of range or not understood. OBJ normals are kept when they are
// numbered like the vertices, PLY normals always.
TriangleMesh read_mesh(const std::string& path);

// Where finished pieces of a mesh go. Not thread-safe. mesh_volume calls append() from a thread of its own while it
// makes the next piece, unless it was given one thread only; finish() and mark() are called when no append() is
// underway.
class MeshSink {
 public:
  virtual ~MeshSink() = default;

  // Appends vertices, numbered on from the ones before (the first ever is 0), their normals (as many as
  // vertices, or none throughout), and triangles over any vertices appended so far. Mesh files refuse an index
  // of no vertex, a coordinate that is not finite and missing normals with std::invalid_argument.
  virtual void append(std::span<const Point> vertices, std::span<const Point> normals,
                      std::span<const std::array<std::uint64_t, 3>> triangles) = 0;

  // Completes the mesh. Without it the destructor discards everything.
  virtual void finish() = 0;

  // Makes what has been appended durable and returns a mark to go on from. Throws std::logic_error unless the sink
  // was opened to keep its parts.
  virtual std::string mark() { throw std::logic_error("this mesh cannot be continued later"); }
};

struct MeshFileOptions {
  bool normals = false;               // STL has no place for vertex normals and ignores them
  std::vector<std::string> comments;  // one line each, into the header where the format has comments

  // An existing folder in which the unfinished mesh is kept as *.part files, whatever happens to the process; they
  // leave it when the mesh is finished. Empty: beside the target, and nothing is kept.
  std::string parts{};
  std::string mark{};  // with the same path and options as before: go on from here, forgetting what came after it
};

// Writes a mesh file, the format by the name's ending: .ply (binary little-endian, 32-bit indices), .stl (binary),
// .obj. The file appears under its name only when finish() has written, counted, flushed and renamed it;
// until then it is a temporary file in the same folder, which the destructor removes.
// Throws CannotWrite when the ending is unknown, the folder is missing or read-only, the disk is full, or the
// format cannot hold the counts; when there are parts already and no mark, or a mark and no such parts. PLY needs room
// for its faces twice while finish() runs; STL keeps the positions of all vertices in memory, 12 bytes each.
std::unique_ptr<MeshSink> open_mesh_file(const std::string& path, const MeshFileOptions& options = {});

// Size of a mesh file of this name with so many vertices and triangles; of text about. Throws CannotWrite when the
// format cannot hold them, or when the ending is unknown.
std::uint64_t mesh_file_bytes(const std::string& path, std::uint64_t vertices, std::uint64_t triangles,
                              bool normals = false);

}  // namespace isoweave
