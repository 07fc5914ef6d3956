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

  // A vertex lies at offset + its coordinates, so that 32 bits hold the shape wherever the mesh lies. All 0 unless
  // coordinates in 32 bits would lose the shape.
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
// GLB and glTF (where the nodes place them, not compressed; isoweave's own files as stored, without the node's unit and
// axes, of several levels the finest, and all of several parts), and 3MF (all items to be built, at their places). The
// format is told by content, then by name. Files may be in gzip, or come out of pipes, which are kept in a file without
// a name in $TMPDIR.
//
// Polygons are cut into triangles. OBJ normals are kept if numbered like the vertices, those of PLY, OFF, VTP, VTK and
// GLB always. Values: the number that a PLY, VTP or VTK file has for each vertex, as docs/formats.md says. `notes` name
// the parts of the file that are not kept. Where a file has more than 32 bits, and rounding to 32 would move a vertex
// by more than a thousandth of the root of twice the mean triangle area, the mesh gets an offset: the one that the file
// names, or one near its middle.
// @throws BadInput for a file that is missing, truncated, out of range or not understood; CannotWrite where there is no
//   room for the content of a pipe
TriangleMesh read_mesh(const std::string& path, const ReadMeshOptions& options = {});

// Makes the coordinates relative to another offset, rounded to 32 bits anew. `mesh.offset` is that offset afterwards.
void move_to_offset(TriangleMesh& mesh, const std::array<double, 3>& offset);

// Brings a mesh into the unit of another one, and from LPS to RAS or back, as far as both say what they are in. The
// offset is converted with the mesh, and is not made that of the other one. Returns what was done, and what was assumed
// where only one of them says its unit or space, one line each.
// @throws std::invalid_argument where one is in index space and the other one is not, and for units that are not known
std::vector<std::string> match_place(TriangleMesh& mesh, const TriangleMesh& other);

// A piece of a mesh on its way to a sink. The spans are valid during the call only.
struct MeshPiece {
  std::span<const Point> vertices{};                          // numbered on from the last piece; the first is 0
  std::span<const Point> normals{};                           // as many as vertices, or none throughout
  std::span<const float> values{};                            // likewise: a number for each vertex
  std::span<const std::array<std::uint64_t, 3>> triangles{};  // over any vertices handed over so far
};

// The counts of a piece of a mesh that is to come.
struct MeshPieceSize {
  std::size_t vertices = 0, triangles = 0;
  bool normals = false, values = false;
};

// Room for a piece, as in MeshPiece. Room for normals and values is there only if the piece has them.
struct MeshRoom {
  std::span<Point> vertices{}, normals{};
  std::span<float> values{};
  std::span<std::array<std::uint32_t, 3>> triangles{};
};

// Where finished pieces of a mesh go. Not thread-safe. mesh_volume calls append() from a thread of its own while it
// makes the next piece, unless it was given one thread only. All other members are called when no append() is underway.
class MeshSink {
 public:
  virtual ~MeshSink() = default;

  // Appends a piece.
  // @throws std::invalid_argument from mesh files for an index of no vertex, a coordinate that is not finite, and
  //   missing normals or values
  virtual void append(const MeshPiece& piece) = 0;

  // Whether there is room() for pieces. Then there is room for all of them, and all threads write them there. For sinks
  // that keep the mesh in memory, where append() would be a copy by one thread.
  virtual bool has_room() const { return false; }

  // Room for the next piece, which is filled before another member is called, unless the run fails.
  // @throws std::length_error for more vertices in all than 32-bit indices can name, 2^32 - 1; std::logic_error where
  //   there is no room for pieces
  virtual MeshRoom room(const MeshPieceSize&) { throw std::logic_error("this sink has no room for pieces"); }

  // Completes the mesh. A sink that is destroyed before this discards everything.
  virtual void finish() = 0;

  // Makes the pieces so far durable, and returns a mark from which the mesh can be continued.
  // @throws std::logic_error unless the sink was opened to keep its parts
  virtual std::string mark() { throw std::logic_error("this mesh cannot be continued later"); }

  // Removes the parts that were kept. To be called when the mesh will not be continued from any mark. finish() leaves
  // the parts, so that a mesh can be continued even if the process dies right after it.
  virtual void forget_marks() {}

  // Notes on the finished mesh for a user, one line each: how far coordinates were rounded, say.
  virtual std::vector<std::string> notes() const { return {}; }

  // The offset that coordinates must be relative to, as in TriangleMesh. mesh_volume and simplify_mesh subtract it in
  // 64 bits before they round to 32.
  // @pre Always the same.
  virtual std::array<double, 3> offset() const { return {0, 0, 0}; }
};

// Keeps a mesh in memory. In a run all threads fill it.
// @cost 12 bytes for each vertex, normal and triangle, 4 for each value. Addresses, not memory, are reserved for up to
//   as much again. RunControl::memory does not count it.
class MeshInMemory final : public MeshSink {
 public:
  // offset: of the mesh; mesh_offset (mesh_options.hpp) gives the one for a volume.
  explicit MeshInMemory(const std::array<double, 3>& offset = {0, 0, 0});
  ~MeshInMemory() override;
  MeshInMemory(MeshInMemory&&) noexcept;
  MeshInMemory& operator=(MeshInMemory&&) noexcept;

  // Both members:
  // @throws std::length_error for more than 2^32 - 1 vertices; std::bad_alloc
  void append(const MeshPiece& piece) override;
  MeshRoom room(const MeshPieceSize& size) override;

  bool has_room() const override { return true; }
  void finish() override {}
  std::array<double, 3> offset() const override { return offset_; }

  // The mesh so far. The spans are valid until the next piece comes.
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

// The formats of mesh files that open_mesh_file writes.
enum class MeshFormat : std::uint8_t { kPly, kStl, kObj, kOff, kGlb, kVtp, k3mf, kPrecomputed };

// The format of a mesh file, by the ending of its name in any case.
// @throws CannotWrite when the ending is unknown
MeshFormat mesh_format(const std::string& path);

// Whether a format has a place for a number at each vertex (MeshFileOptions::values).
bool holds_values(MeshFormat format);

struct MeshFileOptions {
  bool normals = false;               // STL, 3MF and neuroglancer have no place for them and ignore them
  std::vector<std::string> comments;  // one line each, into the file where the format has a place for them

  // An existing folder in which the unfinished mesh is kept as *.part files, however the process ends. forget_marks()
  // removes them. Empty: the unfinished mesh lies beside the target, and is not kept.
  std::string parts{};
  std::string mark{};  // with the same path and options as before: continue here, and forget what came after it

  // The unit and space of the coordinates, as far as they are known. They are in the file where the format has a place
  // for them.
  std::string unit{};   // "mm", "um", "nm", "m" or "in"
  std::string space{};  // "LPS", "RAS" or "index"

  // The offset of all coordinates, as in TriangleMesh: pieces are relative to it. PLY, OBJ, OFF and VTP hold the sums
  // in 64 bits then; GLB, 3MF and packed .precomputed hold a translation; STL and plain .precomputed round the sums to
  // 32 bits, and a note says how far that moves vertices.
  std::array<double, 3> offset{0, 0, 0};

  // .glb: positions rounded to 16 bits of the longest side of their box (KHR_mesh_quantization), packed by
  // meshoptimizer (EXT_meshopt_compression). .precomputed: neuroglancer's multi-resolution format in one shard, one
  // level of detail, cut along the sides of cubes, each a fragment that is rounded to 16 bits of its side and packed by
  // Draco. The bytes do not depend on the order of pieces and triangles. Refused for other formats and by builds
  // without the library.
  bool compress = false;
  std::uint64_t segment = 1;  // .precomputed: the number of the object
  bool values = false;        // PLY (as the property `quality`, which viewers colour by) and VTP only
};

// Writes a mesh file, in the format of the name's ending; docs/formats.md says what each holds:
//   .ply          binary little-endian, 32-bit indices
//   .stl          binary; keeps the positions of all vertices in memory, 12 bytes each
//   .obj, .off    text
//   .glb          glTF 2.0; at most 4 GiB. The node turns the axes to y up and scales to metres, coordinates stay
//   .vtp          VTK XML, appended raw, 64-bit indices
//   .3mf          a zip archive; at most 2^31 vertices
//   .precomputed  neuroglancer's legacy meshes in nanometres: a folder, which must not exist or be empty
// The file or folder appears under its name only when finish() has written, counted, flushed and renamed it. Until then
// it is a temporary file in the same folder, which the destructor removes.
// @throws CannotWrite, also from the sink, when the ending is unknown, the folder is missing or read-only, the disk is
//   full, or the format cannot hold the counts or options; when there are parts already and no mark, or a mark and no
//   such parts
// @cost Disk: all but STL and OBJ need room for the faces twice while finish() runs, .precomputed for all; with
//   `compress` it needs 12 bytes for each vertex and 24 for each triangle from the beginning, and while finish() runs
//   some 50 more for each triangle. Memory: .glb with `compress` has the whole mesh in memory in finish(), .precomputed
//   one fragment; see mesh_file_memory.
std::unique_ptr<MeshSink> open_mesh_file(const std::string& path, const MeshFileOptions& options = {});

// Writes several levels of detail into one file, finest first: returns a sink for each, in that order, for mesh_volume
// with levels. The file appears when all sinks have been finished; destroying one before discards everything. Each
// level has options of its own, of which `normals` and `compress` must be the same.
//   .glb          a mesh for each level in the same data, as nodes of the extension MSFT_lod. Viewers without it, and
//                 read_mesh, see the finest. At most 4 GiB in all
//   .precomputed  with `compress`: a level of neuroglancer's each, cut along cubes that are twice as wide from one to
//                 the next, as are the steps of coordinates. A level of which nothing is left is left out, and all
//                 behind it
// @throws CannotWrite for other formats, and what open_mesh_file throws
// @cost Disk: room for all levels twice while the last one finishes. Memory: for .glb with `compress`, one level at a
//   time and everything that has been packed; for .precomputed what open_mesh_file says.
std::vector<std::unique_ptr<MeshSink>> open_mesh_levels(const std::string& path,
                                                        std::span<const MeshFileOptions> levels);

// One of several meshes in a file, as viewers list and colour it.
struct MeshPart {
  std::string name{};  // any bytes; a viewer shows those that are no UTF-8 as replacement characters
  std::array<double, 4> color{0.87, 0.8, 0.7, 1};  // red, green and blue as sRGB, and opacity, each from 0 to 1
  MeshFileOptions options{};
};

// Writes several parts into one file, each by itself under its name: returns a sink for each, in that order, for
// mesh_iso_values or mesh_labels. The file appears when all sinks have been finished; destroying one before discards
// everything. `normals`, `values`, `compress` and `offset` must be the same for all parts. A part may be empty.
//   .glb  a node, a mesh and a material for each part, below one node that turns and scales all of them. An empty part
//         is a node without a mesh. With `compress` all parts are in steps of one grid. At most 4 GiB in all
//   .vtp  a piece for each part. Its triangles have the cell arrays `part`, which counts from 0, and `color`, 3 x 8
//         bits; the field `PartNames` has the names. Opacity is left out
// read_mesh joins the parts, in their order.
// @throws CannotWrite for other formats, and what open_mesh_file throws; std::invalid_argument for colours out of range
// @cost Disk: room for all parts twice while the last one finishes. Memory: with `compress`, one part at a time and
//   everything that has been packed.
std::vector<std::unique_ptr<MeshSink>> open_mesh_parts(const std::string& path, std::span<const MeshPart> parts);

// One of many objects in a folder, as neuroglancer lists it.
struct MeshObject {
  std::uint64_t segment = 1;  // its number
  std::string name{};         // any bytes; those that are no UTF-8 are replaced
  std::uint64_t samples = 0;  // of the label, from which one can tell large objects from small ones
};

// A folder of objects. They may come in any order, and the folder is the same.
class MeshObjects {
 public:
  virtual ~MeshObjects() = default;

  // A sink for an object, whose mesh is complete when that is finished. Sinks may be open and filled by several threads
  // at the same time; each waits for the others while it finishes. An object without triangles is left out.
  virtual std::unique_ptr<MeshSink> begin(const MeshObject& object) = 0;

  // Writes the folder. All sinks have been finished and destroyed.
  // @throws std::invalid_argument for a number that two objects have; CannotWrite
  virtual void finish() = 0;

  // As those of a sink.
  virtual std::vector<std::string> notes() const = 0;
};

// Writes millions of objects into one folder, named .precomputed and with `compress`, as open_mesh_file writes one; the
// number of the options is not used. The folder has the names and sizes of its objects as neuroglancer's segment
// properties. It appears when finish() is called; destroying the object before discards everything.
// @throws what open_mesh_file throws; CannotWrite for other names and without `compress`
// @cost Disk: what has been packed twice, and 12 bytes for each vertex and 24 for each triangle of objects that are not
//   finished. Memory: 32 KB for each of those, and some 100 bytes for each other.
std::unique_ptr<MeshObjects> open_mesh_objects(const std::string& path, const MeshFileOptions& options = {});

// Writes a mesh in memory, through open_mesh_file, with its offset, and with its normals and values if the options ask
// for them. Unit and space are those of the mesh where the options do not name others.
// @throws what open_mesh_file and its sink throw
void write_mesh(const std::string& path, const TriangleMesh& mesh, const MeshFileOptions& options = {});

// Writes a mesh to an open descriptor, a pipe say, when the mesh is finished. Until then it is in files without names
// in $TMPDIR or /tmp. `format` is "ply" or "stl", and `name` stands for the descriptor in messages. The descriptor
// stays open.
// @pre The program ignores SIGPIPE.
// @throws std::invalid_argument for another format, and when parts are to be kept; CannotWrite from the sink when the
//   descriptor takes no more
std::unique_ptr<MeshSink> open_mesh_stream(int descriptor, const std::string& name, const std::string& format,
                                           const MeshFileOptions& options = {});

// The size in bytes of a mesh file of this name with so many vertices and triangles; about, for text and packed files.
// @throws CannotWrite when the ending is unknown or the format cannot hold the counts or options
std::uint64_t mesh_file_bytes(const std::string& path, std::uint64_t vertices, std::uint64_t triangles,
                              const MeshFileOptions& options = {});

// The bytes, about, that writing such a file holds in memory beside some megabytes of buffers: 0 but for STL and with
// `compress`. For .precomputed at most 56 MB, whatever the counts; more where most of a surface lies in a small part of
// its box, as one fragment is as large then.
// @throws CannotWrite when the ending is unknown
std::uint64_t mesh_file_memory(const std::string& path, std::uint64_t vertices, std::uint64_t triangles,
                               const MeshFileOptions& options = {});

}  // namespace isoweave
#pragma GCC visibility pop
