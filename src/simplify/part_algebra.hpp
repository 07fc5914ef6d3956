// A surface that is cut into parts: parts are split by where their triangles lie, and glued by ids.
//
// Parts of one surface have no triangle in common. A vertex whose triangles lie in several parts is in each of them,
// as the same copy: it blocks, so no part can change it. A final vertex does not block, as no part will change it any
// more. So any part may be decided by itself, at any time, and be split and glued with any others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "parallel/parallel.hpp"
#include "simplify/zone_part.hpp"

namespace isoweave {

// Triangles of a part that go to the same place.
struct SplitPart {
  std::size_t owner = 0;
  ZonePart part;
};

// Splits a part that is not linked. owner(id): the place to which the triangles go whose vertex with the smallest id is
// that one. The parts come with ascending owners, and none is empty.
std::vector<SplitPart> split_part(ZonePart part, const std::function<std::size_t(std::uint64_t)>& owner);

// Parts that are not of one surface. what() tells what they should have.
class UnfitParts : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// Glues parts that are not linked, and links what they are together. Vertices are in ascending order of their ids.
// within: final vertices have no edge up to that cost. Throws UnfitParts.
ZonePart glue_parts(std::vector<ZonePart> parts, CostBits within, const Executor& executor);

}  // namespace isoweave
