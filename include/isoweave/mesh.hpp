// Triangle meshes held in memory, and files of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace isoweave {

using Point = std::array<float, 3>;

// An indexed triangle mesh. 32-bit indices: at most 2^32 - 1 vertices, which read_mesh checks.
struct TriangleMesh {
  std::vector<Point> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<Point> normals{};                         // one per vertex, or none
  std::vector<float> values{};                          // one per vertex, or none; not finite: unknown

  // A vertex lies at offset + its coordinates: 32 bits are spent on the shape and not on how far away it is. All 0
  // unless coordinates in 32 bits would lose the shape.
  std::array<double, 3> offset{0, 0, 0};
  std::string unit{};                // of the coordinates: "mm", "um", "nm", "m" or "in"; empty: not said
  std::string space{};               // "LPS", "RAS" or "index"; empty: not said
  std::vector<std::string> notes{};  // things a user should know, one line each: what a file has and is not kept
};

struct ReadMeshOptions {
  bool external = true;  // whether a file may name others; false, for files from strangers: BadInput
};

// Reads PLY (binary little- and big-endian, ascii), STL (binary, ascii; corners with equal coordinates become one
// vertex), OBJ (v and f), OFF, VTP, VTU and legacy VTK (polygons and strips, PVTP and PVTU with the files they name),
// GLB and glTF (where the nodes place them; what isoweave wrote as stored, without the node's unit and axes, and of
// several levels the finest; not compressed), and 3MF (all that is to be built, at its place); told by content, then by
// name; in gzip, too, and out of pipes, which are kept in a file without a name in $TMPDIR (CannotWrite where there is
// no room). Polygons are cut into triangles. Throws BadInput for what is missing, truncated, out of range or not
// understood. OBJ normals are kept if numbered like the vertices, those of PLY, OFF, VTP, VTK and GLB always. Values:
// the number that a PLY, VTP or VTK file has for each vertex, as docs/formats.md says; `notes` say what is not kept.
// Where a file has more than 32 bits, and rounding to 32 would move a vertex by more than a thousandth of the root of
// twice the mean triangle area, the mesh gets an offset: the one that the file names, or one near its middle.
TriangleMesh read_mesh(const std::string& path, const ReadMeshOptions& options = {});

// Makes the coordinates relative to another offset, rounded to 32 bits anew.
void move_to_offset(TriangleMesh& mesh, const std::array<double, 3>& offset);

// Brings a mesh into the unit of another one, and from LPS to RAS or back, as far as both say what they are in. Returns
// what was done, and what was assumed where one of them only says it, one line each. Throws std::invalid_argument where
// one is in index space and the other one is not. The offset stays its own.
std::vector<std::string> match_place(TriangleMesh& mesh, const TriangleMesh& other);

// A piece of a mesh on its way to a sink.
struct MeshPiece {
  std::span<const Point> vertices{};                          // numbered on from the ones before; the first ever is 0
  std::span<const Point> normals{};                           // as many as vertices, or none throughout
  std::span<const float> values{};                            // likewise: a number for each vertex
  std::span<const std::array<std::uint64_t, 3>> triangles{};  // over any vertices handed over so far
};

// What a piece of a mesh is going to hold.
struct MeshPieceSize {
  std::size_t vertices = 0, triangles = 0;
  bool normals = false, values = false;
};

// Room for a piece, as MeshPiece: of its normals and values only if it has them.
struct MeshRoom {
  std::span<Point> vertices{}, normals{};
  std::span<float> values{};
  std::span<std::array<std::uint32_t, 3>> triangles{};
};

// Where finished pieces of a mesh go. Not thread-safe. mesh_volume calls append() from a thread of its own while it
// makes the next piece, unless it was given one thread only; all other members are called when no append() is underway.
class MeshSink {
 public:
  virtual ~MeshSink() = default;

  // Appends a piece. Mesh files refuse an index of no vertex, a coordinate that is not finite and missing normals or
  // values with std::invalid_argument.
  virtual void append(const MeshPiece& piece) = 0;

  // Whether there is room() for pieces: for all of them then, and all threads write them there. For sinks that keep the
  // mesh in memory, where append() would be a copy by one thread.
  virtual bool has_room() const { return false; }

  // Room for the next piece, which is filled before another member is called, unless the run fails. It refuses more
  // vertices in all than 32-bit indices can name, 2^32 - 1, with std::length_error. Throws std::logic_error where there
  // is none.
  virtual MeshRoom room(const MeshPieceSize&) { throw std::logic_error("this sink has no room for pieces"); }

  // Completes the mesh. Without it the destructor discards everything.
  virtual void finish() = 0;

  // Makes what has been appended durable and returns a mark to go on from. Throws std::logic_error unless the sink
  // was opened to keep its parts.
  virtual std::string mark() { throw std::logic_error("this mesh cannot be continued later"); }

  // To be called when no mark will be gone on from: removes the parts that were kept for that. finish() leaves them, so
  // that a process that dies right behind it can be gone on from as well.
  virtual void forget_marks() {}

  // What a user should know of the finished mesh, one line each: how far coordinates were rounded, say.
  virtual std::vector<std::string> notes() const { return {}; }

  // The coordinates that it wants are relative to this, as those of TriangleMesh are: mesh_volume and simplify_mesh
  // subtract it in 64 bits before they round to 32. Must stay as it is.
  virtual std::array<double, 3> offset() const { return {0, 0, 0}; }
};

// Keeps a mesh in memory: 12 bytes for each vertex, normal and triangle, 4 for each value; addresses, not memory, are
// reserved for up to as much again. In a run all threads fill it. RunControl::memory does not count it.
class MeshInMemory final : public MeshSink {
 public:
  // offset: of the mesh; mesh_offset (pipeline.hpp) tells one for a volume.
  explicit MeshInMemory(const std::array<double, 3>& offset = {0, 0, 0});
  ~MeshInMemory() override;
  MeshInMemory(MeshInMemory&&) noexcept;
  MeshInMemory& operator=(MeshInMemory&&) noexcept;

  // These throw std::length_error for more than 2^32 - 1 vertices, and std::bad_alloc.
  void append(const MeshPiece& piece) override;
  MeshRoom room(const MeshPieceSize& size) override;

  bool has_room() const override { return true; }
  void finish() override {}
  std::array<double, 3> offset() const override { return offset_; }

  // What there is so far, until the next piece comes.
  std::span<const Point> vertices() const;
  std::span<const Point> normals() const;
  std::span<const float> values() const;
  std::span<const std::array<std::uint32_t, 3>> triangles() const;

  TriangleMesh copy() const;

 private:
  struct Arrays;
  std::unique_ptr<Arrays> arrays_;
  std::array<double, 3> offset_;
};

struct MeshFileOptions {
  bool normals = false;               // STL, 3MF and neuroglancer have no place for them and ignore them
  std::vector<std::string> comments;  // one line each, into the file where the format has a place for them

  // An existing folder in which the unfinished mesh is kept as *.part files, whatever happens to the process;
  // forget_marks() removes them from it. Empty: beside the target, and nothing is kept.
  std::string parts{};
  std::string mark{};  // with the same path and options as before: go on from here, forgetting what came after it

  // What the coordinates are, as far as it is known; said in the file where the format has a place for it.
  std::string unit{};   // "mm", "um", "nm", "m" or "in"
  std::string space{};  // "LPS", "RAS" or "index"

  // Of all coordinates, as that of TriangleMesh: pieces are relative to it. PLY, OBJ, OFF and VTP hold the sums in 64
  // bits then, GLB, 3MF and packed .precomputed a translation; STL and plain .precomputed round the sums to 32 bits,
  // and a note says how far that moves vertices.
  std::array<double, 3> offset{0, 0, 0};

  // .glb: positions rounded to 16 bits of the longest side of their box (KHR_mesh_quantization), packed by
  // meshoptimizer (EXT_meshopt_compression). .precomputed: neuroglancer's multi-resolution format, one level of detail,
  // rounded likewise and packed by Draco. Refused for other formats and by builds without the library.
  bool compress = false;
  std::uint64_t segment = 1;  // .precomputed: the number of the object
  bool values = false;        // PLY (as the property `quality`, which viewers colour by) and VTP only
};

// Writes a mesh file, the format by the name's ending; docs/formats.md says what each holds:
//   .ply          binary little-endian, 32-bit indices
//   .stl          binary; keeps the positions of all vertices in memory, 12 bytes each
//   .obj, .off    text
//   .glb          glTF 2.0; at most 4 GiB. The node turns the axes to y up and scales to metres, coordinates stay
//   .vtp          VTK XML, appended raw, 64-bit indices
//   .3mf          a zip archive; at most 2^31 vertices
//   .precomputed  neuroglancer's legacy meshes in nanometres: a folder, which must not exist or be empty
// The file or folder appears under its name only when finish() has written, counted, flushed and renamed it; until then
// it is a temporary file in the same folder, which the destructor removes. Throws CannotWrite when the ending is
// unknown, the folder is missing or read-only, the disk is full, or the format cannot hold the counts; when there are
// parts already and no mark, or a mark and no such parts. All but STL and OBJ need room for the faces twice while
// finish() runs, .precomputed for all. With `compress` the whole mesh is in memory then: see mesh_file_memory.
std::unique_ptr<MeshSink> open_mesh_file(const std::string& path, const MeshFileOptions& options = {});

// Writes several levels of detail into one file, finest first: a sink for each, in that order, for mesh_volume with
// levels. The file appears when all of them have been finished; destroying one before discards everything. Each has
// options of its own, of which `normals` and `compress` must be the same.
//   .glb          a mesh for each in the same data, as nodes of the extension MSFT_lod; viewers that do not know it,
//   and
//                 read_mesh, see the finest. At most 4 GiB in all
//   .precomputed  with `compress`: a level of neuroglancer's each, rounded to steps twice as long from one to the next
// Throws what open_mesh_file throws, and CannotWrite for other formats. Needs room for all levels twice while the last
// one finishes; with `compress` one level at a time is in memory then, and all that has been packed.
std::vector<std::unique_ptr<MeshSink>> open_mesh_levels(const std::string& path,
                                                        std::span<const MeshFileOptions> levels);

// Writes a mesh that is there as a whole, through open_mesh_file, with its offset, and with its normals and values if
// the options ask for them. Its unit and space are those of the mesh where the options do not name others.
void write_mesh(const std::string& path, const TriangleMesh& mesh, const MeshFileOptions& options = {});

// Writes a mesh to an open descriptor, a pipe say, when it is finished; until then it is in files without names in
// $TMPDIR or /tmp. `format` is "ply" or "stl", `name` stands for the descriptor in messages. Throws
// std::invalid_argument for another format, and when parts are to be kept; CannotWrite when the descriptor takes no
// more: the program should ignore SIGPIPE. The descriptor stays open.
std::unique_ptr<MeshSink> open_mesh_stream(int descriptor, const std::string& name, const std::string& format,
                                           const MeshFileOptions& options = {});

// Size of a mesh file of this name with so many vertices and triangles; of text and of packed files about. Throws
// CannotWrite when the format cannot hold them, or when the ending is unknown.
std::uint64_t mesh_file_bytes(const std::string& path, std::uint64_t vertices, std::uint64_t triangles,
                              const MeshFileOptions& options = {});

// What writing such a file holds in memory beside some megabytes of buffers, about: 0 but for STL and with `compress`.
std::uint64_t mesh_file_memory(const std::string& path, std::uint64_t vertices, std::uint64_t triangles,
                               const MeshFileOptions& options = {});

}  // namespace isoweave
#pragma GCC visibility pop
