#include "simplify/hand_over.hpp"

#include "parallel/collect.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kHandOverBlock = 4096;
constexpr std::uint32_t kNew = 2;  // instead of a place: a vertex of the piece that was not handed over before

std::int64_t signed_count(std::size_t count) { return static_cast<std::int64_t>(count); }

}  // namespace

void HandOver::fill(std::span<const Index> triangles, const Receipt& first, FinalPiece& piece) {
  list_vertices(triangles);
  fill_vertices(first, piece);
  piece.locked.resize(0);
  if (zone_.locked > 0) mark_locked(piece);
  fill_triangles(triangles, piece);
}

// Lists the vertices that triangles name, and final ones where they go early, in memory order, and numbers them.
void HandOver::list_vertices(std::span<const Index> triangles) {
  place_.assign(zone_.vertices.size(), 0);
  executor_.for_each(signed_count(triangles.size()), kHandOverBlock, [&](std::int64_t n) {
    for (const HalfEdge& side : zone_.triangles[triangles[static_cast<std::size_t>(n)]].sides) {
      std::atomic_ref(place_[side.vertex]).store(1, std::memory_order_relaxed);
    }
  });
  if (early_) {
    executor_.for_each(signed_count(place_.size()), kHandOverBlock, [&](std::int64_t n) {
      const auto v = static_cast<Index>(n);
      if (is_final(v) && number(v) == kNotHandedOver && exists(zone_.vertices[v].half_edge)) place_[v] = 1;
    });
  }
  list(known_, [&](Index v) {
    const bool known = number(v) != kNotHandedOver;
    if (!known) place_[v] = kNew;
    return known;
  });
  list(new_, [&](Index v) { return place_[v] == kNew; });
  const auto first_new = static_cast<std::uint32_t>(known_.size());
  executor_.for_each(signed_count(known_.size()), kHandOverBlock, [&](std::int64_t n) {
    place_[known_[static_cast<std::size_t>(n)]] = static_cast<std::uint32_t>(n);
  });
  executor_.for_each(signed_count(new_.size()), kHandOverBlock, [&](std::int64_t n) {
    place_[new_[static_cast<std::size_t>(n)]] = first_new + static_cast<std::uint32_t>(n);
  });
}

// Lists the vertices of the piece that select() picks, in memory order.
template <class Select>
void HandOver::list(std::vector<Index>& vertices, const Select& select) {
  collect(
      executor_, signed_count(place_.size()), kHandOverBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& out) {
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          if (place_[v] != 0 && select(v)) out.push_back(v);
        }
      },
      vertices);
}

void HandOver::fill_vertices(const Receipt& first, FinalPiece& piece) const {
  piece.known.resize(known_.size());
  piece.positions.resize(new_.size());
  piece.normals.resize(zone_.normals.empty() ? 0 : new_.size());
  piece.values.resize(zone_.values.empty() ? 0 : new_.size());
  executor_.for_each(signed_count(known_.size()), kHandOverBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const Index v = known_[n];
    piece.known[n] = {zone_.vertices[v].position, {number(v), label(v)}};
  });
  executor_.for_each(signed_count(new_.size()), kHandOverBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const Index v = new_[n];
    piece.positions[n] = zone_.vertices[v].position;
    if (!zone_.normals.empty()) piece.normals[n] = zone_.normals[v];
    if (!zone_.values.empty()) piece.values[n] = zone_.values[v];
    number(v) = first.number + static_cast<std::uint64_t>(n);
    label(v) = first.label + static_cast<std::uint32_t>(n);
  });
}

// Fills in the triangles, and takes them out of the zone or keeps them in the same pass: what it reads is far apart.
void HandOver::fill_triangles(std::span<const Index> triangles, FinalPiece& piece) {
  open_edges_ = 0;
  piece.triangles.resize(triangles.size());
  executor_.for_each(signed_count(triangles.size()), kHandOverBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const Index t = triangles[n];
    for (std::size_t c = 0; c < 3; ++c) piece.triangles[n][c] = place_[zone_.triangles[t].sides[c].vertex];
    is_last() ? take_out(t) : keep(t);
  });
  piece.open_edges = open_edges_;
}

void HandOver::mark_locked(FinalPiece& piece) const {
  piece.locked.resize(known_.size() + new_.size());
  std::size_t n = 0;
  for (const std::vector<Index>* list : {&known_, &new_}) {
    for (const Index v : *list) piece.locked[n++] = zone_.states[v] == VertexState::kLocked ? 1 : 0;
  }
}

void HandOver::count_open(const HalfEdge& side, const HalfEdge& next_side) {
  const bool locked =
      zone_.states[side.vertex] == VertexState::kLocked || zone_.states[next_side.vertex] == VertexState::kLocked;
  if (!locked) open_edges_.fetch_add(1, std::memory_order_relaxed);
}

// Counts that a finer level has the triangle, which stays for the coarser levels.
void HandOver::keep(Index triangle) {
  ++zone_.triangles[triangle].levels;
  const auto& sides = zone_.triangles[triangle].sides;
  for (std::size_t c = 0; c < 3; ++c) {
    if (sides[c].twin == kNone) count_open(sides[c], sides[(c + 1) % 3]);
  }
}

// Removes a triangle, and tells those beside it. Neighbours may leave at the same time.
void HandOver::take_out(Index triangle) {
  auto& sides = zone_.triangles[triangle].sides;
  for (std::size_t c = 0; c < 3; ++c) {
    const Index twin = std::atomic_ref(sides[c].twin).load(std::memory_order_relaxed);
    if (twin == kNone) count_open(sides[c], sides[(c + 1) % 3]);
    if (exists(twin)) std::atomic_ref(zone_.half(twin).twin).store(kWritten, std::memory_order_relaxed);
  }
  zone_.remove_triangle(triangle);
}

void HandOver::change_labels(const std::function<void(std::span<std::uint32_t*>)>& change) {
  std::vector<std::uint32_t*> labels;
  for (Index v = 0; v < zone_.vertices.size(); ++v) {
    if (number(v) != kNotHandedOver) labels.push_back(&label(v));
  }
  change(labels);
}

}  // namespace isoweave
