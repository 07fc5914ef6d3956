#include "mesh/read/mesh_input.hpp"

#include <algorithm>

#include "files/external_files.hpp"
#include "files/part_file.hpp"
#include "files/whole_input.hpp"
#include "isoweave/error.hpp"
#include "isoweave/printable.hpp"
#include "volume/packed_file.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
constexpr std::size_t kLongestMessage = 400;
constexpr std::string_view kMeshFile = "a mesh file";

}  // namespace

MeshInput::MeshInput(const std::string& path, const ReadMeshOptions& options)
    : path_(path),
      options_(options),
      file_(jumping_file(unpacked(open_input_file(path, kMeshFile), kMeshFile))),
      size_(file_->size()),
      buffer_(static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, size_))) {}

std::string MeshInput::named_file(const std::string& name) const {
  OpenOptions options;
  options.external = options_.external;
  check_external(options, path_, name);
  std::string path = beside(path_, name);
  require_part(path_, "a part of the mesh in", path);
  return path;
}

void MeshInput::fail(const std::string& what) const {
  // Words quoted from the file must not break the line, drive a terminal or fill it.
  throw BadInput(printable(path_) + ": " + printable(what.substr(0, kLongestMessage)));
}

// Reads more of the file behind the rest of the buffer.
bool MeshInput::refill() {
  const std::size_t left = filled_ - next_;
  const std::uint64_t from = position_ + left;
  if (from == size_) return false;
  std::memmove(buffer_.data(), buffer_.data() + next_, left);
  next_ = 0;
  filled_ = left;
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_.size() - left, size_ - from));
  const std::size_t got = file_->read_at(from, std::span(buffer_).subspan(left, wanted));
  if (got == 0) fail("ends at byte " + std::to_string(from) + ", it had " + std::to_string(size_) + " when opened");
  filled_ += got;
  return true;
}

std::size_t MeshInput::buffered(std::size_t wanted) {
  while (filled_ - next_ < wanted && wanted <= buffer_.size() && refill()) {
  }
  return filled_ - next_;
}

void MeshInput::read(std::span<std::byte> out) {
  if (out.size() > remaining()) {
    fail("truncated: expected " + std::to_string(out.size()) + " bytes at byte " + std::to_string(position_) +
         ", found " + std::to_string(remaining()));
  }
  while (!out.empty()) {
    if (next_ == filled_) refill();
    const std::size_t count = std::min(out.size(), filled_ - next_);
    std::memcpy(out.data(), buffer_.data() + next_, count);
    next_ += count;
    position_ += count;
    out = out.subspan(count);
  }
}

void MeshInput::skip(std::uint64_t bytes) {
  if (bytes > remaining()) {
    fail("truncated: expected " + std::to_string(bytes) + " bytes at byte " + std::to_string(position_) + ", found " +
         std::to_string(remaining()));
  }
  position_ += bytes;
  if (bytes <= filled_ - next_) {
    next_ += static_cast<std::size_t>(bytes);
  } else {
    next_ = filled_ = 0;
  }
}

void MeshInput::move_to(std::uint64_t position) {
  if (position > size_) {
    fail("truncated: expected data at byte " + std::to_string(position) + ", found " + std::to_string(size_) +
         " bytes in all");
  }
  position_ = position;
  next_ = filled_ = 0;
}

bool MeshInput::read_line(std::string& line, LineEnd end) {
  line.clear();
  ended_in_return_ = false;
  int c = get();
  if (c < 0) return false;
  const auto ends = [end](int at) {
    return at < 0 || (at == '\n' && end != LineEnd::kReturn) || (at == '\r' && end != LineEnd::kNewline);
  };
  for (; !ends(c); c = get()) {
    if (line.size() == kLongestLine) fail("a line is longer than " + std::to_string(kLongestLine) + " bytes");
    line.push_back(static_cast<char>(c));
  }
  if (c == '\r' && end == LineEnd::kAny && peek() == '\n') {
    get();
  } else {
    ended_in_return_ = c == '\r';
  }
  if (end == LineEnd::kNewline && !line.empty() && line.back() == '\r') line.pop_back();
  return true;
}

std::string_view MeshInput::read_token() {
  token_.clear();
  int c = get();
  while (c >= 0 && is_blank(c)) c = get();
  for (; c >= 0 && !is_blank(c); c = get()) {
    if (token_.size() == kLongestToken) fail("a number is longer than " + std::to_string(kLongestToken) + " bytes");
    token_.push_back(static_cast<char>(c));
  }
  return token_;
}

void check_indices(const MeshInput& input, std::span<const std::array<std::uint32_t, 3>> triangles,
                   std::size_t vertices) {
  for (const auto& triangle : triangles) {
    for (const std::uint32_t index : triangle) {
      if (index < vertices) continue;
      input.fail("a triangle refers to vertex " + std::to_string(index) + ", the file has " + std::to_string(vertices) +
                 ", counted from 0");
    }
  }
}

void check_mesh_numbers(const MeshInput& input, const TriangleMesh& mesh) {
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
    for (const float coordinate : mesh.vertices[n]) {
      if (!std::isfinite(coordinate))
        input.fail("vertex " + std::to_string(n) + " has a coordinate that is not finite");
    }
  }
  check_indices(input, mesh.triangles, mesh.vertices.size());
}

void skip_byte_order_mark(MeshInput& input) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (input.head(kMark.size()) == kMark) input.skip(kMark.size());
}

std::string_view take_word(std::string_view& rest) {
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  std::size_t end = 0;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

}  // namespace isoweave::mesh_io
