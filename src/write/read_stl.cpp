// STL stores each triangle with its own corners; corners with equal coordinates become one vertex again.
#include <array>
#include <bit>
#include <cstring>

#include "write/mesh_input.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::uint64_t kHeaderBytes = 84;
constexpr std::uint64_t kTriangleBytes = 50;

std::uint32_t load_u32(const std::byte* in) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(in[i]) << (8 * i);
  return value;
}

// Numbers points in the order of their first appearance: an open-addressing hash table of vertex numbers.
class Welder {
 public:
  Welder(const MeshInput& input, std::vector<Point>& points) : input_(input), points_(points), slots_(1024, kFree) {}

  std::uint32_t number(const Point& point) {
    if (2 * points_.size() >= slots_.size()) grow();
    std::uint32_t& slot = find(point);
    if (slot == kFree) {
      if (points_.size() == kMostVertices) input_.fail("has more than 4294967295 different corners");
      slot = static_cast<std::uint32_t>(points_.size());
      points_.push_back(point);
    }
    return slot;
  }

 private:
  static constexpr std::uint32_t kFree = ~std::uint32_t{0};

  // Adding 0 turns -0 into 0, which compares equal and must hash equal.
  static std::uint64_t hash(const Point& point) {
    std::uint64_t state = 0;
    for (const float coordinate : point) {
      state = (state ^ std::bit_cast<std::uint32_t>(coordinate + 0.0F)) * 0x9e3779b97f4a7c15U;
      state ^= state >> 32;
    }
    return state;
  }

  // The slot that holds an equal point, or the free one where it belongs.
  std::uint32_t& find(const Point& point) {
    std::size_t at = static_cast<std::size_t>(hash(point)) & (slots_.size() - 1);
    while (slots_[at] != kFree && points_[slots_[at]] != point) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::size_t i = 0; i < points_.size(); ++i) find(points_[i]) = static_cast<std::uint32_t>(i);
  }

  const MeshInput& input_;
  std::vector<Point>& points_;
  std::vector<std::uint32_t> slots_;
};

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

// The lines of an ascii STL, word by word.
class StlText {
 public:
  explicit StlText(MeshInput& input) : input_(input) {}

  // Moves to the next line with a word on it; false at the end.
  bool next_line() {
    while (input_.read_line(line_)) {
      ++number_;
      rest_ = line_;
      keyword_ = lower_case(take_word(rest_));
      if (!keyword_.empty()) return true;
    }
    return false;
  }

  void expect_line(std::string_view keyword) {
    if (!next_line()) input_.fail("truncated: expected '" + std::string(keyword) + "', found the end of the file");
    if (keyword_ != keyword) fail("expected '" + std::string(keyword) + "', found '" + keyword_.substr(0, 40) + "'");
  }

  // The three numbers of a "vertex" line.
  Point point() {
    Point point{};
    for (float& coordinate : point) {
      const std::optional<float> value = parse_real<float>(take_word(rest_));
      if (!value || !std::isfinite(*value)) fail("expected three finite numbers after 'vertex'");
      coordinate = *value;
    }
    if (!take_word(rest_).empty()) fail("expected three numbers after 'vertex', found more");
    return point;
  }

  const std::string& keyword() const { return keyword_; }
  [[noreturn]] void fail(const std::string& what) const {
    input_.fail("line " + std::to_string(number_) + ": " + what);
  }

 private:
  static std::string lower_case(std::string_view word) {
    std::string lower(word);
    for (char& c : lower) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return lower;
  }

  MeshInput& input_;
  std::string line_;
  std::string_view rest_;
  std::string keyword_;
  std::uint64_t number_ = 0;
};

// From after "facet" to "endfacet".
std::array<std::uint32_t, 3> read_facet(StlText& text, Welder& welder) {
  std::array<std::uint32_t, 3> corners{};
  text.expect_line("outer");
  for (std::uint32_t& corner : corners) {
    text.expect_line("vertex");
    corner = welder.number(text.point());
  }
  text.expect_line("endloop");
  text.expect_line("endfacet");
  return corners;
}

}  // namespace

bool is_binary_stl(const MeshInput& input) {
  const std::string head = input.head(kHeaderBytes);
  if (head.size() < kHeaderBytes) return false;
  const std::uint64_t count = load_u32(std::as_bytes(std::span(head)).data() + 80);
  return input.size() == kHeaderBytes + count * kTriangleBytes;
}

TriangleMesh read_stl_binary(MeshInput& input) {
  std::array<std::byte, kHeaderBytes> header{};
  input.read(header);
  const std::uint64_t count = load_u32(header.data() + 80);
  if (input.remaining() != count * kTriangleBytes) {
    input.fail("expected " + std::to_string(count * kTriangleBytes) + " bytes of " + std::to_string(count) +
               " triangles after the header, found " + std::to_string(input.remaining()));
  }
  TriangleMesh mesh;
  mesh.triangles.reserve(count);
  Welder welder(input, mesh.vertices);
  for (std::uint64_t triangle = 0; triangle < count; ++triangle) {
    std::array<std::byte, kTriangleBytes> record{};
    input.read(record);
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = welder.number(checked_point(input, load_point(record.data() + 12 + 12 * i), triangle));
    }
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

TriangleMesh read_stl_ascii(MeshInput& input) {
  TriangleMesh mesh;
  Welder welder(input, mesh.vertices);
  StlText text(input);
  while (text.next_line()) {
    if (text.keyword() != "solid") text.fail("expected 'solid', found '" + text.keyword().substr(0, 40) + "'");
    for (;;) {
      if (!text.next_line()) input.fail("truncated: expected 'endsolid', found the end of the file");
      if (text.keyword() == "endsolid") break;
      if (text.keyword() != "facet") text.fail("expected 'facet', found '" + text.keyword().substr(0, 40) + "'");
      mesh.triangles.push_back(read_facet(text, welder));
    }
  }
  return mesh;
}

}  // namespace isoweave::mesh_io
