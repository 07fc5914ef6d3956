// Several levels of detail that become one file. Each level waits in files of its own until all are there.
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

class LevelFile;

// The data of one level: positions, normals and faces as GLB and 3 x 32 bits store them.
class LevelParts final : public MeshFileSink {
 public:
  LevelParts(LevelFile& file, const std::string& path, const MeshFileOptions& options);

  // Appends the level to a file: positions, normals, faces.
  void append_to(AtomicFile& target);

  // The level in memory.
  TriangleMesh load();

  const Bounds& bounds() const { return bounds_; }
  using MeshFileSink::options;
  using MeshFileSink::triangles;
  using MeshFileSink::vertices;

 private:
  std::vector<std::uint64_t> state() const override { return bounds_.state(); }
  void write_piece(const MeshPiece& piece) override;
  void complete() override {}

  LevelFile& file_;
  OutputDescriptor& positions_;
  OutputDescriptor& faces_;
  OutputDescriptor* normals_ = nullptr;
  Bounds bounds_;
  std::vector<std::byte> records_;
};

// The file of all levels. Several threads append to the levels at the same time, each to one.
class LevelFile {
 public:
  // levels: options of each, finest first.
  LevelFile(const std::string& path, std::span<const MeshFileOptions> levels);
  LevelFile(const LevelFile&) = delete;
  LevelFile& operator=(const LevelFile&) = delete;
  virtual ~LevelFile() = default;

  LevelParts& level(std::size_t n) { return levels_[n]; }

  // Called once for each level, when it has everything; the last call writes the file.
  void finish(std::size_t level);

  // Throws CannotWrite when a piece is more than the format holds. Called by any thread.
  virtual void check_room(const LevelParts& level, std::uint64_t vertices, std::uint64_t triangles) = 0;

  bool is_last(std::size_t level) const { return level + 1 == levels_.size(); }
  const std::vector<std::string>& notes() const { return notes_; }

 protected:
  // Writes the file and commits it.
  virtual void write() = 0;

  void note(std::string line) { notes_.push_back(std::move(line)); }
  const std::string& path() const { return path_; }
  std::deque<LevelParts>& levels() { return levels_; }
  const MeshFileOptions& options() const { return levels_.front().options(); }  // of the finest

 private:
  std::string path_;
  std::deque<LevelParts> levels_;
  std::size_t finished_ = 0;
  std::vector<std::string> notes_;
};

std::unique_ptr<LevelFile> open_glb_levels(const std::string& path, std::span<const MeshFileOptions> levels);
std::unique_ptr<LevelFile> open_packed_glb_levels(const std::string& path, std::span<const MeshFileOptions> levels);
std::unique_ptr<LevelFile> open_packed_precomputed_levels(const std::string& path,
                                                          std::span<const MeshFileOptions> levels);

}  // namespace isoweave
