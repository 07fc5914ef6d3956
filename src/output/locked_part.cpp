#include "output/locked_part.hpp"

#include <algorithm>

#include "measure/check_around.hpp"

namespace isoweave {
namespace {

void sort_unique(std::vector<std::uint64_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

void LockedPart::add(const std::array<std::uint64_t, 3>& numbers, const std::array<bool, 3>& locked) {
  triangles_.push_back(numbers);
  for (std::size_t c = 0; c < 3; ++c) {
    if (locked[c]) locked_.push_back(numbers[c]);
  }
}

void LockedPart::report(SurfaceReport& report) const {
  if (triangles_.empty()) return;
  std::vector<std::uint64_t> numbers;
  for (const auto& triangle : triangles_) numbers.insert(numbers.end(), triangle.begin(), triangle.end());
  sort_unique(numbers);
  const auto place = [&](std::uint64_t number) {
    return static_cast<std::uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
  };
  TriangleMesh part;
  part.vertices.resize(numbers.size());  // how triangles meet does not depend on where they are
  for (const auto& t : triangles_) part.triangles.push_back({place(t[0]), place(t[1]), place(t[2])});
  std::vector<std::uint8_t> locked(numbers.size(), 0);
  for (const std::uint64_t number : locked_) locked[place(number)] = 1;
  const AroundCheck around = check_around(part, locked);
  const std::uint64_t other_sides = 3 * report.triangles - around.sides;
  const std::uint64_t edges = (other_sides + report.open_edges) / 2 + around.edges;
  report.euler = static_cast<std::int64_t>(report.vertices + report.triangles) - static_cast<std::int64_t>(edges);
  report.open_edges += around.open_edges;
  report.nonmanifold_edges += around.nonmanifold_edges;
  report.nonmanifold_vertices += around.nonmanifold_vertices;
}

}  // namespace isoweave
