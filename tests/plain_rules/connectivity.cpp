#include "plain_rules/connectivity.hpp"

#include <map>
#include <utility>

namespace isoweave::plain {

Connectivity::Connectivity(const Surface& surface)
    : triangles_(surface.triangles),
      alive_(surface.triangles.size(), true),
      left_(surface.triangles.size()),
      around_(surface.corners.size()) {
  for (const Corner& corner : surface.corners) ids_.push_back(corner.id);
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const std::size_t v : triangles_[t]) around_[v].insert(t);
  }
}

std::vector<std::array<std::size_t, 3>> Connectivity::triangles() const {
  std::vector<std::array<std::size_t, 3>> list;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (alive_[t]) list.push_back(triangles_[t]);
  }
  return list;
}

// The two corners that follow v in a triangle.
std::array<std::size_t, 2> Connectivity::others(std::size_t t, std::size_t v) const {
  const auto& corners = triangles_[t];
  const std::size_t n = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
  return {corners[(n + 1) % 3], corners[(n + 2) % 3]};
}

Ring Connectivity::ring_of(std::size_t v, std::size_t first) const {
  std::map<std::size_t, std::size_t> next;
  std::set<std::size_t> targets;
  for (const std::size_t t : around_[v]) {
    const auto [a, b] = others(t, v);
    next[a] = b;
    targets.insert(b);
  }
  Ring ring;
  for (const auto& [a, b] : next) {
    if (targets.contains(a)) continue;
    ring.open = true;
    first = a;
  }
  ring.around.push_back(first);
  for (std::size_t w = first; next.contains(w) && next[w] != first;) {
    w = next[w];
    ring.around.push_back(w);
  }
  return ring;
}

Ring Connectivity::ring_of(std::size_t v) const {
  std::size_t first = others(*around_[v].begin(), v)[0];
  for (const std::size_t t : around_[v]) {
    const std::size_t corner = others(t, v)[0];
    if (ids_[corner] < ids_[first]) first = corner;
  }
  return ring_of(v, first);
}

std::vector<bool> Connectivity::locked_corners() const {
  std::vector<bool> locked(around_.size(), false);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> sides;
  for (const auto& corners : triangles_) {
    for (std::size_t n = 0; n < 3; ++n) ++sides[{corners[n], corners[(n + 1) % 3]}];
  }
  for (const auto& [side, count] : sides) {
    if (count > 1) locked[side.first] = locked[side.second] = true;
  }
  for (std::size_t v = 0; v < around_.size(); ++v) {
    if (!locked[v] && uses(v) && ring_of(v).faces() != around_[v].size()) locked[v] = true;
  }
  return locked;
}

void Connectivity::remove(std::size_t t) {
  for (const std::size_t v : triangles_[t]) around_[v].erase(t);
  alive_[t] = false;
  --left_;
}

void Connectivity::remove_around(std::size_t v) {
  while (uses(v)) remove(*around_[v].begin());
}

void Connectivity::merge(std::size_t gone, std::size_t into) {
  const std::set<std::size_t> faces = around_[gone];
  for (const std::size_t t : faces) {
    if (around_[into].contains(t)) {
      remove(t);
      continue;
    }
    std::ranges::replace(triangles_[t], gone, into);
    around_[into].insert(t);
  }
  around_[gone].clear();
}

}  // namespace isoweave::plain
