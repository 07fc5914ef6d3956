// Ids of vertices and of mesh edges.
#include "lattice/vertex_numbering.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

namespace isoweave::testing::vertex_numbering_test {
namespace {

using Dims = std::array<std::int64_t, 3>;

struct Numbered {
  Dims point;
  std::uint64_t id;
};

// Every id that a numbering has on its padded lattice.
std::vector<Numbered> all_ids(const VertexNumbering& numbering) {
  std::vector<Numbered> all;
  const Dims& dims = numbering.lattice.dims;
  for (std::int64_t k = -1; k <= dims[2]; ++k) {
    for (std::int64_t j = -1; j <= dims[1]; ++j) {
      for (std::int64_t i = -1; i <= dims[0]; ++i) {
        for (std::uint32_t slot = 0; slot < numbering.slots; ++slot) {
          all.push_back({{i, j, k}, numbering.id(i, j, k, slot)});
        }
      }
    }
  }
  return all;
}

bool are_near(const Dims& a, const Dims& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::abs(a[axis] - b[axis]) > 1) return false;
  }
  return true;
}

// Vertices on cube edges; on the seven edges of a lattice of tetrahedra; in faces and cells as well.
std::vector<VertexNumbering> numberings(const Dims& dims) {
  return {VertexNumbering::of_cube_edges(dims),
          {{dims}, 7, 512, {1, 2, 3, 4, 5, 6, 7}},
          {{dims}, 10, 1024, {1, 2, 4}},
          {{dims}, 16, 1024, {}}};
}

TEST(VertexNumbering, NamesEveryVertexAndEveryMeshEdgeOnce) {
  for (const Dims& dims : {Dims{1, 1, 2}, {2, 1, 1}, {3, 4, 2}}) {
    for (const VertexNumbering& numbering : numberings(dims)) {
      SCOPED_TRACE(numbering.slots);
      const std::vector<Numbered> all = all_ids(numbering);
      std::set<std::uint64_t> ids, edges;
      std::size_t pairs = 0;
      for (const Numbered& a : all) {
        ids.insert(a.id);
        EXPECT_EQ(numbering.place(a.id).low, a.point);
        for (const Numbered& b : all) {
          if (a.id >= b.id || !are_near(a.point, b.point)) continue;
          EXPECT_EQ(numbering.edge_id(a.id, b.id), numbering.edge_id(b.id, a.id));
          edges.insert(numbering.edge_id(a.id, b.id));
          ++pairs;
        }
      }
      EXPECT_EQ(ids.size(), all.size());
      EXPECT_EQ(edges.size(), pairs);
    }
  }
}

TEST(VertexNumbering, OfAFileTakesPlaces) {
  const VertexNumbering numbering = VertexNumbering::of_file();
  EXPECT_EQ(numbering.edge_id(7, 5), (std::uint64_t{5} << 32) + 7);
}

TEST(VertexNumbering, KnowsLayersAndBorders) {
  const VertexNumbering numbering = VertexNumbering::of_cube_edges({4, 4, 4});
  EXPECT_EQ(numbering.layer_of(numbering.id(1, 1, 2, 0)), 1) << "on slice 2, made by the layer below";
  EXPECT_EQ(numbering.layer_of(numbering.id(1, 1, 2, 2)), 2) << "between slices 2 and 3";
  EXPECT_TRUE(numbering.is_on_border(numbering.id(1, 0, 2, 0)));
  EXPECT_TRUE(numbering.is_on_border(numbering.id(3, 1, 2, 2)));
  EXPECT_FALSE(numbering.is_on_border(numbering.id(0, 1, 2, 0))) << "crosses into the volume";
}

TEST(VertexNumbering, KnowsWhenIdsDoNotFit) {
  EXPECT_TRUE(VertexNumbering::of_cube_edges({65536, 65536, 65536}).fits());
  const std::int64_t million = std::int64_t{1} << 20;
  EXPECT_FALSE(VertexNumbering::of_cube_edges({million, million, million}).fits());
  EXPECT_GT(VertexNumbering::of_cube_edges({70000, 70000, 70000}).id(0, 0, 1, 0), std::uint64_t{1} << 32);
}

}  // namespace
}  // namespace isoweave::testing::vertex_numbering_test
