#include "output/final_output.hpp"

#include <array>

namespace isoweave {
namespace {

constexpr std::int64_t kFinalBlock = 4096;

}  // namespace

void FinalOutput::take(FinalSource& source) {
  do {
    const Receipt first = end();
    source.take_final(first, piece_);
    write(first.number);
    if (piece_.locked.size() > 0) keep_locked(first.number);
    open_edges_ += piece_.open_edges;
  } while (source.has_more());
  if (output_.components().labels() <= source.held_vertices()) return;
  source.change_labels([&](std::span<std::uint32_t*> labels) { output_.components().compact(labels); });
}

void FinalOutput::serialize(StateWriter& state) const {
  state.value(open_edges_);
  output_.serialize(state);
}

void FinalOutput::serialize(StateReader& state) {
  state.value(open_edges_);
  output_.serialize(state);
}

void FinalOutput::write(std::uint64_t first_number) {
  corners_.resize(piece_.known.size());
  executor_.for_each(static_cast<std::int64_t>(corners_.size()), kFinalBlock, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const KnownVertex& vertex = piece_.known[n];
    ISOWEAVE_CHECK(vertex.receipt.number < first_number);
    corners_[n] = {vertex.receipt.number, vertex.receipt.label, output_.point(vertex.position)};
  });
  output_.take(OutputPiece{piece_.positions, piece_.normals, piece_.values, piece_.triangles}, corners_);
}

// Keeps the triangles around locked vertices.
void FinalOutput::keep_locked(std::uint64_t first_number) {
  const std::size_t known = piece_.known.size();
  for (const auto& triangle : piece_.triangles) {
    std::array<std::uint64_t, 3> numbers{};
    std::array<bool, 3> locked{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = triangle[c];
      numbers[c] = v < known ? piece_.known[v].receipt.number : first_number + (v - known);
      locked[c] = piece_.locked[v] != 0;
    }
    if (locked[0] || locked[1] || locked[2]) locked_part_.add(numbers, locked);
  }
}

}  // namespace isoweave
