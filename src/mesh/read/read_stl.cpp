// STL stores each triangle with its own corners; corners with equal coordinates become one vertex again.
#include <algorithm>
#include <array>
#include <bit>

#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_leftovers.hpp"
#include "mesh/read/mesh_place.hpp"
#include "mesh/read/welder.hpp"
#include "parallel/size.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::uint64_t kHeaderBytes = 84;
constexpr std::size_t kCountAt = 80;
constexpr std::uint64_t kTriangleBytes = 50;
constexpr std::uint64_t kUnfilledCount = 0xffffffff;

std::uint32_t load_u32(const std::byte* in) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(in[i]) << (8 * i);
  return value;
}

// The number of a corner among those that differ.
std::uint32_t number_of(const MeshInput& input, Welder& welder, const Point& point) {
  const std::uint32_t number = welder.number(point);
  if (number == Welder::kMostPoints) input.fail("has more than 4294967295 different corners");
  return number;
}

Point checked_point(const MeshInput& input, const Point& point, std::uint64_t triangle) {
  for (const float coordinate : point) {
    if (!std::isfinite(coordinate)) {
      input.fail("triangle " + std::to_string(triangle) + " has a coordinate that is not finite");
    }
  }
  return point;
}

Point load_point(const std::byte* in) {
  return {std::bit_cast<float>(load_u32(in)), std::bit_cast<float>(load_u32(in + 4)),
          std::bit_cast<float>(load_u32(in + 8))};
}

// Reads the place from the text of a header, which ends at the first 0, or is as long as there is room.
void take_place(std::span<const std::byte> header, TriangleMesh& mesh) {
  std::string text;
  for (const std::byte c : header.first(kCountAt)) text.push_back(static_cast<char>(c));
  MeshPlace place;
  place.take_comment(text.substr(0, text.find('\0')));
  place.put_into(mesh);
}

// The number of triangles to read, after the header has been read. Some programs never fill in the count, and some add
// data of their own behind the triangles.
std::uint64_t read_count(MeshInput& input, TriangleMesh& mesh) {
  std::array<std::byte, kHeaderBytes> header{};
  input.read(header);
  take_place(header, mesh);
  const std::uint64_t said = load_u32(header.data() + kCountAt);
  const std::uint64_t there = input.remaining() / kTriangleBytes;
  const std::uint64_t behind = input.remaining() % kTriangleBytes;
  if (said == there && behind == 0) return said;
  const bool unfilled = said == 0 || said == kUnfilledCount;
  if (behind == 0 && there > 0 && (unfilled || said < there) && there <= kUnfilledCount) {
    mesh.notes.push_back("its header counts " + std::to_string(said) + " triangles, its length " +
                         std::to_string(there) + ", which are read");
    return there;
  }
  if (said == 0 || said > there) {
    input.fail("expected " + std::to_string(said * kTriangleBytes) + " bytes of " + std::to_string(said) +
               " triangles after the header, found " + std::to_string(input.remaining()));
  }
  mesh.notes.push_back("left out: " + std::to_string(input.remaining() - said * kTriangleBytes) +
                       " bytes behind the last triangle");
  return said;
}

// Notes colours. Two bytes of each triangle have no meaning in STL itself; VisCAM and Magics keep a colour there.
void note_attributes(std::uint64_t triangles, TriangleMesh& mesh) {
  MeshLeftovers leftovers;
  leftovers.left_out(triangles, "attributes of triangles, which may be colours");
  leftovers.note(mesh);
}

}  // namespace

bool is_binary_stl(const MeshInput& input) {
  const std::string head = input.head(kHeaderBytes);
  if (head.size() < kHeaderBytes) return false;
  const std::uint64_t count = load_u32(std::as_bytes(std::span(head)).data() + kCountAt);
  return input.size() == kHeaderBytes + count * kTriangleBytes;
}

bool looks_like_text(std::string_view head) {
  return std::none_of(head.begin(), head.end(), [](const char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && !is_blank(byte) && c != kEndOfText) || byte == 0x7f;
  });
}

TriangleMesh read_stl_binary(MeshInput& input) {
  TriangleMesh mesh;
  const std::uint64_t count = read_count(input, mesh);
  mesh.triangles.reserve(to_size(count));
  Welder welder(mesh.vertices);
  std::uint64_t attributes = 0;
  for (std::uint64_t triangle = 0; triangle < count; ++triangle) {
    std::array<std::byte, kTriangleBytes> record{};
    input.read(record);
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Point point = checked_point(input, load_point(record.data() + 12 + 12 * i), triangle);
      corners[i] = number_of(input, welder, point);
    }
    mesh.triangles.push_back(corners);
    if (record[48] != std::byte{0} || record[49] != std::byte{0}) ++attributes;
  }
  note_attributes(attributes, mesh);
  return mesh;
}

}  // namespace isoweave::mesh_io
