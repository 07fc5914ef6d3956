// The common part of the mesh writers: checked arguments, counts, the files behind a sink, and the order append...
// finish.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/atomic_file.hpp"
#include "isoweave/mesh.hpp"

namespace isoweave {

using Triangle64 = std::array<std::uint64_t, 3>;

// The target of a finished mesh.
struct MeshTarget {
  enum class Kind { kFile, kFolder, kStream, kJoined };  // kJoined: a mesh of a file that others write as well

  std::string path;  // as the user gave it; what stands for a stream in messages
  Kind kind = Kind::kFile;
  int descriptor = -1;  // of a stream
};

// Whether coordinates come relative to an offset. The format holds their sums in 64 bits then, if it can.
inline bool has_offset(const MeshFileOptions& options) { return options.offset != std::array<double, 3>{0, 0, 0}; }

// The place of a vertex.
inline std::array<double, 3> placed(const Point& point, const std::array<double, 3>& offset) {
  return {offset[0] + double{point[0]}, offset[1] + double{point[1]}, offset[2] + double{point[2]}};
}

// "x,y,z", with the fewest digits that read back as the same numbers.
std::string offset_text(const std::array<double, 3>& offset);

// Coordinates plus offset, rounded to 32 bits, for formats that have no more, and how far rounding moves them.
class RoundedPlaces {
 public:
  // scale: of the numbers in the file.
  RoundedPlaces(std::string path, const MeshFileOptions& options, double scale = 1);

  // Throws CannotWrite where a coordinate does not fit in 32 bits.
  Point point(const Point& relative);

  // One line about how far vertices were moved, or none.
  std::vector<std::string> notes() const;

  // The state as a number of a mark.
  std::vector<std::uint64_t> state() const { return {std::bit_cast<std::uint64_t>(farthest_)}; }
  void load(const std::vector<std::uint64_t>& state) { farthest_ = std::bit_cast<double>(state.front()); }

 private:
  std::string path_, unit_;
  std::array<double, 3> offset_;
  double scale_;
  double farthest_ = 0;
};

class MeshFileSink : public MeshSink {
 public:
  // Throws std::invalid_argument for an index of no vertex, a coordinate that is not finite, or missing normals:
  // a file with those could not be read back. Nothing may follow a failed call.
  void append(const MeshPiece& piece) final;
  void finish() final;
  std::string mark() final;
  void forget_marks() final;
  std::array<double, 3> offset() const final { return options_.offset; }

 protected:
  MeshFileSink(MeshTarget target, const MeshFileOptions& options);

  // Whether the mesh goes on from a mark.
  bool continued() const { return !options_.mark.empty(); }

  // The file that becomes the mesh. A folder has none.
  OutputDescriptor& file() { return atomic_ ? atomic_->descriptor() : *stream_; }

  // Opens a further file that pieces are written to: beside the mesh's own part, or, where no parts are kept, without a
  // name. The constructor must open it, always in the same order.
  OutputDescriptor& open_side(const std::string& name);

  // The further numbers that a format needs to continue; and the numbers of the mark, to be taken once all sides are
  // open.
  virtual std::vector<std::uint64_t> state() const { return {}; }
  std::vector<std::uint64_t> saved_state(std::size_t count);

  // Writes a checked piece; normals and values are empty unless the options ask for them. vertices() and triangles()
  // still count what came before it.
  virtual void write_piece(const MeshPiece& piece) = 0;

  // Writes the bytes that pieces have left in the format's own buffers.
  virtual void write_held_back() {}

  // Writes the parts that are known only at the end, and checks the file against the counts.
  virtual void complete() = 0;

  // Throws CannotWrite when the file is not as long as its counts say, or does not begin with `header`.
  void check_written(std::uint64_t expected_bytes, std::span<const std::byte> header);

  const std::string& path() const { return target_.path; }
  const MeshFileOptions& options() const { return options_; }
  bool has_offset() const { return isoweave::has_offset(options_); }

  // The place of a vertex, with its offset.
  std::array<double, 3> placed(const Point& point) const { return isoweave::placed(point, options_.offset); }
  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t triangles() const { return triangles_; }

 private:
  enum class State { kOpen, kFailed, kFinished };

  std::string part_path(const std::string& name) const { return options_.parts + "/" + name; }
  PartFile part(const std::string& name);
  void open_file();
  int open_side_scratch() const;
  std::uint64_t next_saved();
  void check_piece(const MeshPiece& piece) const;
  void require_open() const;

  MeshTarget target_;
  MeshFileOptions options_;
  std::deque<std::uint64_t> saved_;  // numbers of the mark that nobody has taken yet
  std::optional<AtomicFile> atomic_;
  std::optional<OutputDescriptor> stream_;
  std::vector<std::string> side_names_;
  std::deque<OutputDescriptor> sides_;
  std::uint64_t vertices_ = 0;
  std::uint64_t triangles_ = 0;
  State state_ = State::kOpen;
};

// Options as they are for a format without a place for normals.
MeshFileOptions without_normals(MeshFileOptions options);

// The comments, then one each for the space and the unit in the form that 3D Slicer reads ("SPACE=LPS", "UNIT=mm"), and
// one for the offset, if there is one.
std::vector<std::string> comment_lines(const MeshFileOptions& options);

// The text of a comment as one line: control characters, line ends above all, become blanks.
std::string one_line(const std::string& comment);

std::unique_ptr<MeshSink> open_ply(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_stl(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_obj(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_off(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_glb(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_packed_glb(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_vtp(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_3mf(const MeshTarget& target, const MeshFileOptions& options);
std::unique_ptr<MeshSink> open_precomputed(const MeshTarget& target, const MeshFileOptions& options);

// Little-endian stores that advance `out`.
inline void store_u32(std::byte*& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) *out++ = static_cast<std::byte>(value >> shift & 0xffU);
}

inline void store_wide_point(std::byte*& out, const std::array<double, 3>& point) {
  for (const double coordinate : point) {
    const auto bits = std::bit_cast<std::uint64_t>(coordinate);
    store_u32(out, static_cast<std::uint32_t>(bits));
    store_u32(out, static_cast<std::uint32_t>(bits >> 32));
  }
}

inline void store_point(std::byte*& out, const Point& point) {
  for (const float coordinate : point) store_u32(out, std::bit_cast<std::uint32_t>(coordinate));
}

inline void store_indices(std::byte*& out, const Triangle64& triangle) {
  for (const std::uint64_t index : triangle) store_u32(out, static_cast<std::uint32_t>(index));
}

// Writes records of one size, thousands at a time. encode(out, n) stores the n-th and advances `out` by its size.
template <class Encode>
void write_records(OutputDescriptor& file, std::vector<std::byte>& buffer, std::size_t count, std::size_t record_bytes,
                   const Encode& encode) {
  constexpr std::size_t kAtOnce = 4096;
  buffer.resize(kAtOnce * record_bytes);
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    const std::size_t end = std::min(count, first + kAtOnce);
    std::byte* out = buffer.data();
    for (std::size_t n = first; n < end; ++n) encode(out, n);
    file.write(std::span(buffer).first((end - first) * record_bytes));
  }
}

}  // namespace isoweave
