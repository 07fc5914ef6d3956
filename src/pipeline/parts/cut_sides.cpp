#include "pipeline/parts/cut_sides.hpp"

#include <numeric>
#include <utility>

namespace isoweave {

bool BlockSides::is_cut(std::uint64_t id) const {
  const VertexNumbering::Place place = numbering.place(id);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (cells.first[axis] > all.first[axis] && lies_at(place, axis, cells.first[axis])) return true;
    if (cells.end[axis] < all.end[axis] && lies_at(place, axis, cells.end[axis])) return true;
  }
  return false;
}

bool BlockSides::is_own(std::uint64_t id) const {
  const VertexNumbering::Place place = numbering.place(id);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (cells.end[axis] < all.end[axis] && lies_at(place, axis, cells.end[axis])) return false;
  }
  return true;
}

bool BlockSides::on_border(std::uint64_t a, std::uint64_t b) const {
  const VertexNumbering::Place from = numbering.place(a);
  const VertexNumbering::Place to = numbering.place(b);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::int64_t plane : {all.first[axis], all.end[axis]}) {
      if (lies_at(from, axis, plane) && lies_at(to, axis, plane)) return true;
    }
  }
  return false;
}

namespace {

constexpr std::uint32_t kNotCut = ~std::uint32_t{0};

}  // namespace

void CutSides::apply(SurfacePiece& piece) {
  const std::uint32_t from_extractor = piece.inherited;
  const auto name = [&](std::uint32_t v) { return v < from_extractor ? names_[v] : inherited_ + (v - from_extractor); };
  for (auto& triangle : piece.triangles) {
    for (std::uint32_t& corner : triangle) corner = name(corner);
  }
  std::vector<std::uint32_t> places;
  std::vector<std::uint32_t> incomplete = list_cut(piece, places);
  const auto cut = static_cast<std::uint32_t>(incomplete.size());
  std::vector<std::uint32_t> names;
  for (const std::uint32_t v : piece.incomplete) {
    const std::uint32_t old = v < from_extractor && names_[v] < cut_ ? names_[v] : kNotCut;
    const std::uint32_t place = v < from_extractor ? old : places[v - from_extractor];
    names.push_back(place != kNotCut ? place : static_cast<std::uint32_t>(incomplete.size()));
    if (place == kNotCut) incomplete.push_back(name(v));
  }
  piece.inherited = inherited_;
  cut_ = cut;
  inherited_ = static_cast<std::uint32_t>(incomplete.size());
  names_ = std::move(names);
  piece.incomplete = std::move(incomplete);
}

// Lists the vertices at cuts, the new ones last. places: where each new vertex is in that list, or kNotCut.
std::vector<std::uint32_t> CutSides::list_cut(const SurfacePiece& piece, std::vector<std::uint32_t>& places) {
  std::vector<std::uint32_t> list(cut_);
  std::iota(list.begin(), list.end(), 0U);
  places.assign(piece.ids.size(), kNotCut);
  for (std::uint32_t n = 0; n < places.size(); ++n) {
    foreign_ += static_cast<std::uint64_t>(!sides_.is_own(piece.ids[n]));
    if (!sides_.is_cut(piece.ids[n])) continue;
    places[n] = static_cast<std::uint32_t>(list.size());
    list.push_back(inherited_ + n);
  }
  return list;
}

}  // namespace isoweave
