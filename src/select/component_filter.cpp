#include "select/component_filter.hpp"

#include <algorithm>
#include <span>

#include "isoweave/error.hpp"
#include "parallel/compact.hpp"
#include "parallel/union_find.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kFilterBlock = 4096;

}  // namespace

void ComponentFilter::apply(SurfacePiece& piece) {
  find_parts(piece);
  judge_parts(piece);
  if (!agrees_with_front()) refuse();
  front_is_kept_.resize(piece.incomplete.size());
  for (std::size_t n = 0; n < front_is_kept_.size(); ++n) front_is_kept_[n] = kept_[piece.incomplete[n]];
  const bool all = std::find(kept_.begin(), kept_.end(), 0) == kept_.end();
  if (!all) drop(piece);
  triangles_ += piece.triangles.size();
}

std::optional<std::uint64_t> ComponentFilter::inherited(std::uint64_t before) const {
  if (before != front_is_kept_.size()) return std::nullopt;
  return static_cast<std::uint64_t>(std::count(front_is_kept_.begin(), front_is_kept_.end(), 1));
}

void ComponentFilter::serialize(StateWriter& state) const {
  state.list(front_is_kept_);
  state.value(triangles_);
}

void ComponentFilter::serialize(StateReader& state) {
  state.list(front_is_kept_);
  for (const std::uint8_t kept : front_is_kept_) state.require(kept <= 1, "vertices that are kept or not");
  state.value(triangles_);
}

void ComponentFilter::refuse() const {
  throw BadInput(path_ +
                 ": the volume has changed: expected the surface that components were chosen in, found another");
}

void ComponentFilter::find_parts(const SurfacePiece& piece) {
  parents_.resize(piece.inherited + piece.positions.size());
  executor_.for_each(static_cast<std::int64_t>(parents_.size()), kFilterBlock,
                     [&](std::int64_t n) { parents_[static_cast<std::size_t>(n)] = static_cast<std::uint32_t>(n); });
  executor_.for_each(static_cast<std::int64_t>(piece.triangles.size()), kFilterBlock, [&](std::int64_t n) {
    const auto& [a, b, c] = piece.triangles[static_cast<std::size_t>(n)];
    join_sets(parents_, a, b);
    join_sets(parents_, a, c);
  });
}

// Judges every connected part of a piece by its first vertex: that vertex is inherited, or a seed.
void ComponentFilter::judge_parts(const SurfacePiece& piece) {
  kept_.resize(parents_.size());
  const auto each_vertex = [&](const auto& visit) {
    executor_.for_each(static_cast<std::int64_t>(parents_.size()), kFilterBlock,
                       [&](std::int64_t n) { visit(static_cast<std::uint32_t>(n)); });
  };
  each_vertex([&](std::uint32_t v) {
    if (parents_[v] != v) return;
    kept_[v] = v < piece.inherited ? front_is_kept_[v] : std::uint8_t{keeps_seed(piece.ids[v - piece.inherited])};
  });
  each_vertex([&](std::uint32_t v) {
    const std::uint32_t root = find_root(parents_, v);
    if (root != v) kept_[v] = kept_[root];
  });
}

// Whether every inherited vertex is in a part that is judged as the vertex was before.
bool ComponentFilter::agrees_with_front() const {
  return std::equal(front_is_kept_.begin(), front_is_kept_.end(), kept_.begin());
}

bool ComponentFilter::keeps_seed(std::uint64_t id) const {
  return std::binary_search(choice_.seeds.begin(), choice_.seeds.end(), id) == choice_.seeds_are_kept;
}

void ComponentFilter::drop(SurfacePiece& piece) const {
  const std::uint32_t inherited = piece.inherited;
  std::vector<std::uint32_t> number(inherited);
  piece.inherited = 0;
  for (std::uint32_t v = 0; v < inherited; ++v) number[v] = kept_[v] != 0 ? piece.inherited++ : Compaction::kDropped;
  const Compaction vertices(executor_, piece.positions.size(),
                            [&](std::size_t n) { return kept_[inherited + n] != 0; });
  const auto renumber = [&](std::uint32_t& v) {
    v = v < inherited ? number[v] : piece.inherited + vertices[v - inherited];
  };
  const Compaction triangles(executor_, piece.triangles.size(),
                             [&](std::size_t n) { return kept_[piece.triangles[n][0]] != 0; });
  triangles.apply(piece.triangles, [&](auto& triangle) {
    for (std::uint32_t& v : triangle) renumber(v);
  });
  std::erase_if(piece.incomplete, [&](std::uint32_t v) { return kept_[v] == 0; });
  for (std::uint32_t& v : piece.incomplete) renumber(v);
  vertices.apply(piece.positions);
  vertices.apply(piece.ids);
  if (!piece.normals.empty()) vertices.apply(piece.normals);
  if (!piece.values.empty()) vertices.apply(piece.values);
  if (piece.open_edges > 0) piece.open_edges = count_open_edges(piece);
}

std::uint64_t ComponentFilter::count_open_edges(const SurfacePiece& piece) const {
  return static_cast<std::uint64_t>(
      std::count_if(piece.ids.begin(), piece.ids.end(), [&](std::uint64_t id) { return numbering_.is_on_border(id); }));
}

}  // namespace isoweave
