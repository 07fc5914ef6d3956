#include "mesh/write/mesh_file_sink.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "files/atomic_folder.hpp"
#include "isoweave/error.hpp"
#include "mesh/write/mesh_text.hpp"

namespace isoweave {
namespace {

constexpr const char* kMeshPart = "mesh.part";

bool all_finite(std::span<const Point> points) {
  return std::all_of(points.begin(), points.end(),
                     [](const Point& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); });
}

std::string temporary_folder() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  return error ? "/tmp" : folder.string();
}

std::deque<std::uint64_t> parse_mark(const MeshFileOptions& options) {
  std::deque<std::uint64_t> numbers;
  if (options.mark.empty()) return numbers;
  std::istringstream text(options.mark);
  for (std::uint64_t number = 0; text >> number;) numbers.push_back(number);
  if (!text.eof() || numbers.size() < 2 || options.parts.empty()) {
    throw std::invalid_argument("expected the mark of a mesh and the folder of its parts, found '" + options.mark +
                                "' and '" + options.parts + "'");
  }
  return numbers;
}

}  // namespace

std::string offset_text(const std::array<double, 3>& offset) {
  std::string text;
  for (const double number : offset) {
    if (!text.empty()) text += ',';
    print(text, number);
  }
  return text;
}

RoundedPlaces::RoundedPlaces(std::string path, const MeshFileOptions& options, double scale)
    : path_(std::move(path)), unit_(options.unit), offset_(options.offset), scale_(scale) {}

Point RoundedPlaces::point(const Point& relative) {
  Point result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = (offset_[axis] + double{relative[axis]}) * scale_;
    if (!(std::abs(at) <= double{std::numeric_limits<float>::max()})) {
      throw CannotWrite(path_ + ": the format holds coordinates of 32 bits, the mesh lies farther from the origin");
    }
    result[axis] = static_cast<float>(at);
    farthest_ = std::max(farthest_, std::abs(double{result[axis]} - at) / scale_);
  }
  return result;
}

std::vector<std::string> RoundedPlaces::notes() const {
  if (farthest_ == 0) return {};
  std::ostringstream text;
  text.precision(3);
  text << "warning: " << path_ << ": so far from the origin coordinates of 32 bits move vertices by up to " << farthest_
       << (unit_.empty() ? "" : " ") << unit_ << "; .ply, .vtp, .obj, .off, .glb and .3mf keep them in place";
  return {text.str()};
}

MeshFileSink::MeshFileSink(MeshTarget target, const MeshFileOptions& options)
    : target_(std::move(target)), options_(options), saved_(parse_mark(options)) {
  if (continued()) {
    vertices_ = next_saved();
    triangles_ = next_saved();
  }
  open_file();
}

void MeshFileSink::open_file() {
  switch (target_.kind) {
    case MeshTarget::Kind::kFile:
      if (options_.parts.empty()) {
        atomic_.emplace(target_.path);
      } else {
        atomic_.emplace(target_.path, part(kMeshPart));
      }
      break;
    case MeshTarget::Kind::kFolder:
      AtomicFolder::check_free(target_.path);
      break;
    case MeshTarget::Kind::kStream:
      if (!options_.parts.empty()) throw std::invalid_argument(path() + ": a stream cannot be continued later");
      stream_.emplace(open_side_scratch(), path());
      break;
    case MeshTarget::Kind::kJoined:
      break;
  }
}

std::uint64_t MeshFileSink::next_saved() {
  if (saved_.empty()) throw std::invalid_argument("the mark '" + options_.mark + "' is not one of this format");
  const std::uint64_t number = saved_.front();
  saved_.pop_front();
  return number;
}

std::vector<std::uint64_t> MeshFileSink::saved_state(std::size_t count) {
  std::vector<std::uint64_t> numbers(count);
  for (std::uint64_t& number : numbers) number = next_saved();
  return numbers;
}

// A part file of a mesh that is continued, with the next two numbers of its mark.
PartFile MeshFileSink::part(const std::string& name) {
  PartFile file{part_path(name), std::nullopt};
  if (!continued()) return file;
  const std::uint64_t size = next_saved();
  file.mark = PartMark{size, static_cast<std::uint32_t>(next_saved())};
  return file;
}

int MeshFileSink::open_side_scratch() const {
  switch (target_.kind) {
    case MeshTarget::Kind::kFolder:
    case MeshTarget::Kind::kJoined:
      return open_scratch_in(folder_of(without_slashes(path())), path());
    case MeshTarget::Kind::kStream:
      return open_scratch_in(temporary_folder(), path());
    case MeshTarget::Kind::kFile:
      break;
  }
  return open_scratch(path());
}

OutputDescriptor& MeshFileSink::open_side(const std::string& name) {
  side_names_.push_back(name);
  if (options_.parts.empty()) return sides_.emplace_back(open_side_scratch(), path());
  return sides_.emplace_back(open_part(part(name)));
}

std::string MeshFileSink::mark() {
  require_open();
  if (options_.parts.empty()) return MeshSink::mark();
  write_held_back();
  std::vector<std::uint64_t> numbers{vertices_, triangles_};
  const auto add = [&](OutputDescriptor& part) {
    part.sync();
    numbers.push_back(part.size());
    numbers.push_back(*part.checksum());
  };
  if (atomic_) add(file());
  for (OutputDescriptor& side : sides_) add(side);
  for (const std::uint64_t number : state()) numbers.push_back(number);
  std::string text;
  for (const std::uint64_t number : numbers) text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}

void MeshFileSink::require_open() const {
  if (state_ == State::kFinished) throw std::logic_error(path() + ": the mesh is already finished");
  if (state_ == State::kFailed) throw std::logic_error(path() + ": an earlier write failed, the mesh cannot go on");
}

void MeshFileSink::check_piece(const MeshPiece& piece) const {
  const std::size_t vertices = piece.vertices.size();
  const auto matches = [&](std::size_t found, bool wanted) { return found == vertices || (found == 0 && !wanted); };
  if (!matches(piece.normals.size(), options_.normals)) {
    throw std::invalid_argument("expected one normal for each vertex");
  }
  if (!matches(piece.values.size(), options_.values)) throw std::invalid_argument("expected one value for each vertex");
  if (!all_finite(piece.vertices) || !all_finite(piece.normals)) {
    throw std::invalid_argument("a vertex or normal has a coordinate that is not finite");
  }
  const std::uint64_t count = vertices_ + vertices;
  for (const Triangle64& triangle : piece.triangles) {
    if (std::max({triangle[0], triangle[1], triangle[2]}) >= count) {
      throw std::invalid_argument("a triangle refers to a vertex that was not appended");
    }
  }
}

void MeshFileSink::append(const MeshPiece& piece) {
  require_open();
  check_piece(piece);
  state_ = State::kFailed;  // until all is written
  MeshPiece wanted = piece;
  if (!options_.normals) wanted.normals = {};
  if (!options_.values) wanted.values = {};
  write_piece(wanted);
  vertices_ += piece.vertices.size();
  triangles_ += piece.triangles.size();
  state_ = State::kOpen;
}

void MeshFileSink::finish() {
  require_open();
  state_ = State::kFailed;
  for (OutputDescriptor& side : sides_) side.verify();
  complete();
  if (atomic_) atomic_->commit();
  if (stream_) stream_->copy_to(target_.descriptor, path());
  state_ = State::kFinished;
}

void MeshFileSink::forget_marks() {
  if (options_.parts.empty()) return;
  if (atomic_) remove_part(part_path(kMeshPart));
  for (const std::string& name : side_names_) remove_part(part_path(name));
}

void MeshFileSink::check_written(std::uint64_t expected_bytes, std::span<const std::byte> header) {
  if (file().size() != expected_bytes) {
    throw CannotWrite(path() + ": its counts make " + std::to_string(expected_bytes) + " bytes, " +
                      std::to_string(file().size()) + " were written");
  }
  std::vector<std::byte> found(header.size());
  file().read_back(0, found);
  if (!std::equal(header.begin(), header.end(), found.begin())) {
    throw CannotWrite(path() + ": its header does not read back as it was written");
  }
}

MeshFileOptions without_normals(MeshFileOptions options) {
  options.normals = false;
  return options;
}

std::vector<std::string> comment_lines(const MeshFileOptions& options) {
  std::vector<std::string> lines;
  for (const std::string& comment : options.comments) lines.push_back(one_line(comment));
  if (!options.space.empty()) lines.push_back("SPACE=" + one_line(options.space));
  if (!options.unit.empty()) lines.push_back("UNIT=" + one_line(options.unit));
  if (has_offset(options)) lines.push_back("OFFSET=" + offset_text(options.offset));
  return lines;
}

std::string one_line(const std::string& comment) {
  std::string line = comment;
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7f) c = ' ';
  }
  return line;
}

}  // namespace isoweave
