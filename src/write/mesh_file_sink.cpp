#include "write/mesh_file_sink.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr const char* kMeshPart = "mesh.part";

bool all_finite(std::span<const Point> points) {
  return std::all_of(points.begin(), points.end(),
                     [](const Point& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); });
}

std::string lower_case_ending(const std::string& path) {
  const std::size_t name = path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1;
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || dot < name) return "";
  std::string ending = path.substr(dot);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

}  // namespace

MeshFileSink::MeshFileSink(const std::string& path, const MeshFileOptions& options)
    : path_(path),
      options_(options),
      begin_(parse_mark(options)),
      file_(options.parts.empty() ? AtomicFile(path) : AtomicFile(path, part(kMeshPart, begin_.bytes))),
      vertices_(begin_.vertices),
      triangles_(begin_.triangles) {}

MeshFileSink::Mark MeshFileSink::parse_mark(const MeshFileOptions& options) {
  Mark mark;
  if (options.mark.empty()) return mark;
  std::istringstream text(options.mark);
  std::string rest;
  const bool read = static_cast<bool>(text >> mark.vertices >> mark.triangles >> mark.bytes >> mark.side_bytes);
  if (!read || text >> rest || options.parts.empty()) {
    throw std::invalid_argument("expected the mark of a mesh and the folder of its parts, found '" + options.mark +
                                "' and '" + options.parts + "'");
  }
  return mark;
}

PartFile MeshFileSink::part(const std::string& name, std::uint64_t size) const {
  return {options_.parts + "/" + name, continued() ? std::optional(size) : std::nullopt};
}

OutputDescriptor& MeshFileSink::open_side(const std::string& name) {
  side_name_ = name;
  return options_.parts.empty() ? side_.emplace(open_scratch(path_), path_)
                                : side_.emplace(open_part(part(name, begin_.side_bytes)));
}

std::string MeshFileSink::mark() {
  require_open();
  if (options_.parts.empty()) return MeshSink::mark();
  write_held_back();
  file_.sync();
  if (side_) side_->sync();
  const std::uint64_t side_bytes = side_ ? side_->size() : 0;
  return std::to_string(vertices_) + " " + std::to_string(triangles_) + " " + std::to_string(file_.size()) + " " +
         std::to_string(side_bytes);
}

void MeshFileSink::require_open() const {
  if (state_ == State::kFinished) throw std::logic_error(path_ + ": the mesh is already finished");
  if (state_ == State::kFailed) throw std::logic_error(path_ + ": an earlier write failed, the mesh cannot go on");
}

void MeshFileSink::check_piece(std::span<const Point> vertices, std::span<const Point> normals,
                               std::span<const Triangle64> triangles) const {
  const bool normals_match = normals.size() == vertices.size() || (normals.empty() && !options_.normals);
  if (!normals_match) throw std::invalid_argument("expected one normal for each vertex");
  if (!all_finite(vertices) || !all_finite(normals)) {
    throw std::invalid_argument("a vertex or normal has a coordinate that is not finite");
  }
  const std::uint64_t count = vertices_ + vertices.size();
  for (const Triangle64& triangle : triangles) {
    if (std::max({triangle[0], triangle[1], triangle[2]}) >= count) {
      throw std::invalid_argument("a triangle refers to a vertex that was not appended");
    }
  }
}

void MeshFileSink::append(std::span<const Point> vertices, std::span<const Point> normals,
                          std::span<const Triangle64> triangles) {
  require_open();
  check_piece(vertices, normals, triangles);
  state_ = State::kFailed;  // until all is written
  write_piece(vertices, options_.normals ? normals : std::span<const Point>{}, triangles);
  vertices_ += vertices.size();
  triangles_ += triangles.size();
  state_ = State::kOpen;
}

void MeshFileSink::finish() {
  require_open();
  state_ = State::kFailed;
  complete();
  file_.commit();
  if (side_ && !options_.parts.empty()) remove_part(part(side_name_, 0));
  state_ = State::kFinished;
}

void MeshFileSink::check_written(std::uint64_t expected_bytes, std::span<const std::byte> header) {
  if (file_.size() != expected_bytes) {
    throw CannotWrite(path_ + ": its counts make " + std::to_string(expected_bytes) + " bytes, " +
                      std::to_string(file_.size()) + " were written");
  }
  std::vector<std::byte> found(header.size());
  file_.read_back(0, found);
  if (!std::equal(header.begin(), header.end(), found.begin())) {
    throw CannotWrite(path_ + ": its header does not read back as it was written");
  }
}

void check_count_fits(const std::string& path, const char* what, std::uint64_t have, std::uint64_t more) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (have > kMost || more > kMost - have) {
    throw CannotWrite(path + ": the format holds at most " + std::to_string(kMost) + " " + what +
                      ", the mesh has more");
  }
}

std::string one_line(const std::string& comment) {
  std::string line = comment;
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7f) c = ' ';
  }
  return line;
}

namespace {

enum class MeshFormat { kPly, kStl, kObj };

MeshFormat format_of(const std::string& path) {
  const std::string ending = lower_case_ending(path);
  if (ending == ".ply") return MeshFormat::kPly;
  if (ending == ".stl") return MeshFormat::kStl;
  if (ending == ".obj") return MeshFormat::kObj;
  throw CannotWrite(path + ": expected a name that ends in .ply, .stl or .obj");
}

}  // namespace

std::unique_ptr<MeshSink> open_mesh_file(const std::string& path, const MeshFileOptions& options) {
  switch (format_of(path)) {
    case MeshFormat::kPly:
      return open_ply(path, options);
    case MeshFormat::kStl:
      return open_stl(path, options);
    case MeshFormat::kObj:
      break;
  }
  return open_obj(path, options);
}

std::uint64_t mesh_file_bytes(const std::string& path, std::uint64_t vertices, std::uint64_t triangles, bool normals) {
  constexpr std::uint64_t kObjVertexBytes = 32;  // a line of text
  constexpr std::uint64_t kObjFaceBytes = 24;
  switch (format_of(path)) {
    case MeshFormat::kPly:
      check_count_fits(path, "vertices", 0, vertices);
      return vertices * (normals ? 24 : 12) + triangles * 13;
    case MeshFormat::kStl:
      check_count_fits(path, "triangles", 0, triangles);
      return triangles * 50;
    case MeshFormat::kObj:
      break;
  }
  return vertices * kObjVertexBytes * (normals ? 2 : 1) + triangles * kObjFaceBytes * (normals ? 2 : 1);
}

}  // namespace isoweave
