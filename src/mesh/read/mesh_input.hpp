// The tools that mesh readers share: a file read from front to back through a bounded buffer, and numbers from text.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/from_chars.hpp"
#include "files/input_file.hpp"
#include "isoweave/mesh.hpp"

namespace isoweave::mesh_io {

// Every failure is BadInput with one line that begins with the path.
class MeshInput {
 public:
  // Opens a regular file, or the content of a pipe. A file in gzip is inflated into a file without a name, as readers
  // go back and ask how much is left. Throws CannotWrite where there is no room for that.
  explicit MeshInput(const std::string& path, const ReadMeshOptions& options = {});
  MeshInput(const MeshInput&) = delete;
  MeshInput& operator=(const MeshInput&) = delete;

  const std::string& path() const { return path_; }
  const FilePtr& file() const { return file_; }

  // The path of a file that this one names. Fails where it may name none.
  std::string named_file(const std::string& name) const;
  std::uint64_t size() const { return size_; }
  std::uint64_t remaining() const { return size_ - position_; }

  // The next byte, or -1 at the end.
  int get() {
    if (next_ == filled_ && !refill()) return -1;
    ++position_;
    return std::to_integer<int>(buffer_[next_++]);
  }

  void read(std::span<std::byte> out);
  void skip(std::uint64_t bytes);

  // Reads records of `bytes` bytes each, at most `most` of them: take(const std::byte*) sees one after the other until
  // it answers false. The record that it refuses, and a part of a record at the end of the file, count as not read.
  // Returns the number of records read.
  template <class Take>
  std::uint64_t read_records(std::uint64_t most, std::size_t bytes, const Take& take) {
    std::uint64_t taken = 0;
    while (taken < most && buffered(bytes) >= bytes) {
      const std::uint64_t here = std::min<std::uint64_t>(most - taken, (filled_ - next_) / bytes);
      std::uint64_t n = 0;
      while (n < here && take(buffer_.data() + next_ + n * bytes)) ++n;
      next_ += n * bytes;
      position_ += n * bytes;
      taken += n;
      if (n < here) break;
    }
    return taken;
  }

  // Continues at this byte, wherever the file stood. Fails when the file is not so long.
  void move_to(std::uint64_t position);

  // The end of a line: any of "
  // ", "\r
  // " and "\r"; "
  // ", with a "\r" before it or not; or "\r" alone. After the last two, binary data may follow a line.
  enum class LineEnd { kAny, kNewline, kReturn };

  // The next line without its end; false at the end of the file.
  bool read_line(std::string& line, LineEnd end = LineEnd::kAny);

  // Whether the last line that was read ended in "\r" alone.
  bool ended_in_return() const { return ended_in_return_; }

  // The next run of characters that are not blanks or line ends; empty at the end of the file.
  std::string_view read_token();

  // Up to `bytes` bytes from the beginning, without moving.
  std::string head(std::size_t bytes) const { return file_->head(bytes); }

  [[noreturn]] void fail(const std::string& what) const;

 private:
  bool refill();

  // The next byte without taking it, or -1 at the end.
  int peek() { return next_ == filled_ && !refill() ? -1 : std::to_integer<int>(buffer_[next_]); }

  // The number of the next bytes that the buffer holds: all that are wanted, if the buffer and the file have so many.
  std::size_t buffered(std::size_t wanted);

  std::string path_;
  ReadMeshOptions options_;
  FilePtr file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;  // of the next byte to hand out
  std::vector<std::byte> buffer_;
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::string token_;
  bool ended_in_return_ = false;
};

// Longest line and token accepted; a file without line ends must not be read into memory whole.
inline constexpr std::size_t kLongestLine = std::size_t{1} << 20;
inline constexpr std::size_t kLongestToken = 256;

inline constexpr char kEndOfText = 0x1a;  // stands behind texts that come from DOS

inline bool is_blank(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// Passes over the three bytes by which some programs mark UTF-8.
void skip_byte_order_mark(MeshInput& input);

// Takes the first word off `rest`; empty when there is none.
std::string_view take_word(std::string_view& rest);

// The whole of `text` as a decimal integer.
template <class Integer>
std::optional<Integer> parse_integer(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Integer value{};
  const auto [end, error] = number_from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// The whole of `text` as the nearest number of type Real; "inf" and "nan" are numbers here.
template <class Real>
std::optional<Real> parse_real(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Real value{};
  const auto [end, error] = number_from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc{}) return value;
  if constexpr (sizeof(Real) < sizeof(double)) {
    // Too small or too large for a float: a double says which.
    const std::optional<double> wide =
        error == std::errc::result_out_of_range ? parse_real<double>(text) : std::nullopt;
    if (wide && std::abs(*wide) < 1) return static_cast<Real>(*wide);
  }
  return std::nullopt;
}

// Adds the fan over a polygon, corner by corner.
class PolygonFan {
 public:
  explicit PolygonFan(std::vector<std::array<std::uint32_t, 3>>& triangles) : triangles_(triangles) {}

  void add(std::uint32_t corner) {
    if (corners_ == 0) first_ = corner;
    if (corners_ >= 2) triangles_.push_back({first_, previous_, corner});
    previous_ = corner;
    ++corners_;
  }
  std::uint64_t corners() const { return corners_; }

 private:
  std::vector<std::array<std::uint32_t, 3>>& triangles_;
  std::uint32_t first_ = 0;
  std::uint32_t previous_ = 0;
  std::uint64_t corners_ = 0;
};

inline constexpr std::uint64_t kMostVertices = std::numeric_limits<std::uint32_t>::max();

// Fails when a triangle refers to a vertex that is not there.
void check_indices(const MeshInput& input, std::span<const std::array<std::uint32_t, 3>> triangles,
                   std::size_t vertices);

// Fails when an index is out of range or a coordinate is not finite.
void check_mesh_numbers(const MeshInput& input, const TriangleMesh& mesh);

TriangleMesh read_ply(MeshInput& input);
TriangleMesh read_off(MeshInput& input);
// PolyData and flat cells of unstructured grids, also of files that name others for their pieces.
TriangleMesh read_vtp(MeshInput& input);
TriangleMesh read_vtk(MeshInput& input);
TriangleMesh read_glb(MeshInput& input);
TriangleMesh read_3mf(MeshInput& input);
TriangleMesh read_stl_binary(MeshInput& input);
TriangleMesh read_stl_ascii(MeshInput& input);
TriangleMesh read_obj(MeshInput& input);

// Whether the file is exactly as long as the count in a binary STL header makes it.
bool is_binary_stl(const MeshInput& input);

// Whether a word is the first of an OFF file: 'OFF' with letters before it that say what vertices have.
bool is_off_keyword(std::string_view word);

// Whether bytes from the beginning of a file are those of a text: no control characters but those of blanks.
bool looks_like_text(std::string_view head);

}  // namespace isoweave::mesh_io
