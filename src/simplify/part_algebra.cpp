#include "simplify/part_algebra.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "simplify/part_copy.hpp"
#include "simplify/part_linker.hpp"

namespace isoweave {
namespace {

// The owner of each triangle of a part.
std::vector<std::size_t> owners_of(const ZonePart& part, const std::function<std::size_t(std::uint64_t)>& owner) {
  std::vector<std::size_t> owners(part.triangles.size());
  for (std::size_t t = 0; t < owners.size(); ++t) {
    std::uint64_t least = ~std::uint64_t{0};
    for (const HalfEdge& side : part.triangles[t].sides) least = std::min(least, part.vertices[side.vertex].id);
    owners[t] = owner(least);
  }
  return owners;
}

// Where each vertex of each part lies in the glued one.
class Places {
 public:
  explicit Places(const std::vector<ZonePart>& parts) {
    std::size_t count = 0;
    for (const ZonePart& part : parts) count += part.vertices.size();
    copies_.reserve(count);
    for (std::size_t n = 0; n < parts.size(); ++n) {
      places_.emplace_back(parts[n].vertices.size());
      for (Index v = 0; v < parts[n].vertices.size(); ++v) copies_.push_back({parts[n].vertices[v].id, n, v});
    }
    std::sort(copies_.begin(), copies_.end(),
              [](const Copy& a, const Copy& b) { return a.id != b.id ? a.id < b.id : a.part < b.part; });
    number();
  }

  std::size_t vertices() const { return vertices_; }
  Index of(std::size_t part, Index v) const { return places_[part][v]; }

 private:
  struct Copy {
    std::uint64_t id;
    std::size_t part;
    Index vertex;
  };

  void number() {
    for (std::size_t n = 0; n < copies_.size(); ++n) {
      vertices_ += n == 0 || copies_[n].id != copies_[n - 1].id;
      places_[copies_[n].part][copies_[n].vertex] = static_cast<Index>(vertices_ - 1);
    }
    copies_ = {};
  }

  std::vector<Copy> copies_;
  std::vector<std::vector<Index>> places_;  // per part and vertex
  std::size_t vertices_ = 0;
};

void require_whole(bool holds, const char* what) {
  if (!holds) throw UnfitParts(std::string("parts of a surface: expected ") + what);
}

constexpr std::uint64_t kNoId = ~std::uint64_t{0};

// Checks that a vertex is the same in two parts, where another one has brought it already.
void check_copy(const Vertex& here, const Vertex& copy) {
  if (here.id == kNoId) return;
  const Vec3 apart = here.position - copy.position;
  require_whole(dot(apart, apart) == 0 && here.number == copy.number, "copies of vertices that are the same");
}

// Puts the vertices and triangles of a part where they belong in the glued one.
void add_part(const ZonePart& part, std::size_t number, const Places& places, ZonePart& glued) {
  for (const Vertex& vertex : part.vertices) {
    check_copy(glued.vertices[places.of(number, static_cast<Index>(&vertex - part.vertices.begin()))], vertex);
  }
  for_vertex_arrays(part, glued, [&](const auto& from, auto& to) {
    to.resize(from.empty() ? to.size() : places.vertices());
    for (Index v = 0; v < from.size(); ++v) to[places.of(number, v)] = from[v];
  });
  const std::size_t first = glued.triangles.size();
  glued.triangles.resize(first + part.triangles.size());
  for (std::size_t t = 0; t < part.triangles.size(); ++t) {
    Triangle& triangle = glued.triangles[first + t];
    triangle = part.triangles[t];
    for (HalfEdge& side : triangle.sides) side.vertex = places.of(number, side.vertex);
  }
}

}  // namespace

std::vector<SplitPart> split_part(ZonePart part, const std::function<std::size_t(std::uint64_t)>& owner) {
  const std::vector<std::size_t> owners = owners_of(part, owner);
  std::map<std::size_t, std::vector<Index>> triangles;
  for (Index t = 0; t < owners.size(); ++t) triangles[owners[t]].push_back(t);
  std::vector<SplitPart> split;
  if (triangles.size() == 1) {
    split.push_back({triangles.begin()->first, std::move(part)});
    return split;
  }
  std::vector<Index> place(part.vertices.size(), kNone);
  for (const auto& [to, list] : triangles) split.push_back({to, copy_some(part, list, place)});
  return split;
}

ZonePart glue_parts(std::vector<ZonePart> parts, CostBits within, const Executor& executor) {
  const Places places(parts);
  ZonePart glued;
  glued.vertices.resize(places.vertices());
  Vertex none;
  none.id = kNoId;
  std::fill(glued.vertices.begin(), glued.vertices.end(), none);
  for (std::size_t n = 0; n < parts.size(); ++n) {
    add_part(parts[n], n, places, glued);
    parts[n] = {};
  }
  for (Vertex& vertex : glued.vertices) vertex.half_edge = kNone;
  link_part(glued, within, PartScope::kSome, executor, require_whole);
  return glued;
}

}  // namespace isoweave
