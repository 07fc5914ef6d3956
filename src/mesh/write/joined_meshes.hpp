// Several meshes that become one file: levels of detail, or named parts. Each waits in files of its own until all are
// there.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mesh/write/glb_scene.hpp"
#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {

class JoinedFile;

// How a mesh waits: as the file will store it.
enum class JoinedForm : std::uint8_t {
  kNarrow,  // faces of 3 x 32 bits, normals with a direction
  kWide     // faces of 3 x 64 bits, normals as they come
};

// The data of one mesh: positions, normals, values and faces.
class JoinedMesh final : public MeshFileSink {
 public:
  JoinedMesh(JoinedFile& file, const std::string& path, const MeshFileOptions& options, JoinedForm form);

  // Appends the mesh to a file: positions, normals, faces.
  void append_to(AtomicFile& target);

  // The mesh in memory.
  // @pre The narrow form.
  TriangleMesh load();

  const Bounds& bounds() const { return bounds_; }
  OutputDescriptor& positions() { return positions_; }
  OutputDescriptor& faces() { return faces_; }
  OutputDescriptor* normals() { return normals_; }
  OutputDescriptor* values() { return values_; }
  using MeshFileSink::options;
  using MeshFileSink::triangles;
  using MeshFileSink::vertices;

 private:
  std::vector<std::uint64_t> state() const override { return bounds_.state(); }
  void write_piece(const MeshPiece& piece) override;
  void write_narrow(const MeshPiece& piece);
  void complete() override {}

  JoinedFile& file_;
  JoinedForm form_;
  OutputDescriptor& positions_;
  OutputDescriptor& faces_;
  OutputDescriptor* normals_ = nullptr;
  OutputDescriptor* values_ = nullptr;
  Bounds bounds_;
  std::vector<std::byte> records_;
};

// The file of all meshes. Several threads append to the meshes at the same time, each to one.
class JoinedFile {
 public:
  JoinedFile(const std::string& path, std::span<const MeshFileOptions> meshes, JoinedForm form = JoinedForm::kNarrow);
  JoinedFile(const JoinedFile&) = delete;
  JoinedFile& operator=(const JoinedFile&) = delete;
  virtual ~JoinedFile() = default;

  JoinedMesh& mesh(std::size_t n) { return meshes_[n]; }

  // Called once for each mesh, when it has everything; the last call writes the file.
  void finish(std::size_t mesh);

  // Throws CannotWrite when a piece is more than the format holds. Called by any thread.
  virtual void check_room(const JoinedMesh& mesh, std::uint64_t vertices, std::uint64_t triangles) = 0;

  bool is_last(std::size_t mesh) const { return mesh + 1 == meshes_.size(); }
  const std::vector<std::string>& notes() const { return notes_; }

 protected:
  // Writes the file and commits it.
  virtual void write() = 0;

  void note(std::string line) { notes_.push_back(std::move(line)); }
  const std::string& path() const { return path_; }
  std::deque<JoinedMesh>& meshes() { return meshes_; }
  const MeshFileOptions& options() const { return meshes_.front().options(); }  // of the first

  // The corners of the boxes of all meshes that have vertices.
  std::vector<Point> corners() const;

 private:
  std::string path_;
  std::deque<JoinedMesh> meshes_;
  std::size_t finished_ = 0;
  std::vector<std::string> notes_;
};

std::vector<MeshFileOptions> options_of(std::span<const MeshPart> parts);

// Levels of detail, finest first.
std::unique_ptr<JoinedFile> open_glb_levels(const std::string& path, std::span<const MeshFileOptions> levels);
std::unique_ptr<JoinedFile> open_packed_glb_levels(const std::string& path, std::span<const MeshFileOptions> levels);
std::unique_ptr<JoinedFile> open_packed_precomputed_levels(const std::string& path,
                                                           std::span<const MeshFileOptions> levels);

// Objects with numbers.
std::unique_ptr<MeshObjects> open_packed_precomputed_objects(const std::string& path, const MeshFileOptions& options);

// Named parts.
std::unique_ptr<JoinedFile> open_glb_parts(const std::string& path, std::span<const MeshPart> parts);
std::unique_ptr<JoinedFile> open_packed_glb_parts(const std::string& path, std::span<const MeshPart> parts);
std::unique_ptr<JoinedFile> open_vtp_parts(const std::string& path, std::span<const MeshPart> parts);

}  // namespace isoweave
