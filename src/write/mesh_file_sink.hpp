// What the mesh writers share: checked arguments, counts, and the order append... finish.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "isoweave/mesh.hpp"
#include "write/atomic_file.hpp"

namespace isoweave {

using Triangle64 = std::array<std::uint64_t, 3>;

class MeshFileSink : public MeshSink {
 public:
  // Throws std::invalid_argument for an index of no vertex, a coordinate that is not finite, or missing normals:
  // a file with those could not be read back. Nothing may follow a failed call.
  void append(std::span<const Point> vertices, std::span<const Point> normals,
              std::span<const Triangle64> triangles) final;
  void finish() final;
  std::string mark() final;

 protected:
  MeshFileSink(const std::string& path, const MeshFileOptions& options);

  // Whether the mesh goes on from a mark.
  bool continued() const { return !options_.mark.empty(); }

  // A second file that pieces are written to: beside the mesh's own part, or, where no parts are kept, without a name.
  // To be opened by the constructor or never.
  OutputDescriptor& open_side(const std::string& name);

  // Writes a checked piece; `normals` is empty unless the options ask for them. vertices() and triangles() still
  // count what came before it.
  virtual void write_piece(std::span<const Point> vertices, std::span<const Point> normals,
                           std::span<const Triangle64> triangles) = 0;

  // Writes what pieces have left in buffers of the format's own.
  virtual void write_held_back() {}

  // Writes what can only be written at the end, and checks the file against the counts.
  virtual void complete() = 0;

  // Throws CannotWrite when the file is not as long as its counts say, or does not begin with `header`.
  void check_written(std::uint64_t expected_bytes, std::span<const std::byte> header);

  const std::string& path() const { return path_; }
  const MeshFileOptions& options() const { return options_; }
  AtomicFile& file() { return file_; }
  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t triangles() const { return triangles_; }

 private:
  enum class State { kOpen, kFailed, kFinished };

  PartFile part(const std::string& name, std::uint64_t size) const;
  void check_piece(std::span<const Point> vertices, std::span<const Point> normals,
                   std::span<const Triangle64> triangles) const;
  void require_open() const;

  // How far a mesh has come; as text it is the mark.
  struct Mark {
    std::uint64_t vertices = 0, triangles = 0, bytes = 0, side_bytes = 0;
  };

  static Mark parse_mark(const MeshFileOptions& options);

  std::string path_;
  MeshFileOptions options_;
  Mark begin_;
  AtomicFile file_;
  std::string side_name_;
  std::optional<OutputDescriptor> side_;
  std::uint64_t vertices_;
  std::uint64_t triangles_;
  State state_ = State::kOpen;
};

// Throws CannotWrite when a 32-bit count in the file cannot say `have` + `more`.
void check_count_fits(const std::string& path, const char* what, std::uint64_t have, std::uint64_t more);

// The text of a comment as one line: control characters, line ends above all, become blanks.
std::string one_line(const std::string& comment);

std::unique_ptr<MeshSink> open_ply(const std::string& path, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_stl(const std::string& path, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_obj(const std::string& path, const MeshFileOptions& options);

// Little-endian stores that advance `out`.
inline void store_u32(std::byte*& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) *out++ = static_cast<std::byte>(value >> shift & 0xffU);
}

inline void store_point(std::byte*& out, const Point& point) {
  for (const float coordinate : point) store_u32(out, std::bit_cast<std::uint32_t>(coordinate));
}

}  // namespace isoweave
