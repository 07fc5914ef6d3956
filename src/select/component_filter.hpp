// Components that are not kept go before anything downstream sees them.
#pragma once

#include <cstdint>
#include <vector>

#include "extract/surface_piece.hpp"
#include "isoweave/components.hpp"
#include "lattice/lattice.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

class ComponentFilter {
 public:
  // The choice must outlive the filter.
  ComponentFilter(const ComponentChoice& choice, const Lattice& lattice, const Executor& executor)
      : choice_(choice), lattice_(lattice), executor_(executor) {}

  // Takes what is dropped out of the next piece: what is left keeps its order, as if there had never been more. False,
  // and nothing is changed, when a component is kept in part: the choice is not one of this surface.
  bool apply(SurfacePiece& piece);

  std::uint64_t triangles() const { return triangles_; }  // kept so far

  // The state between two pieces.
  template <class Archive>
  void exchange(Archive& archive) {
    archive.list(front_is_kept_);
    archive.value(triangles_);
  }

 private:
  void find_parts(const SurfacePiece& piece);
  void judge_parts(const SurfacePiece& piece);
  bool agrees_with_front() const;
  void drop(SurfacePiece& piece) const;
  bool keeps_seed(std::uint64_t id) const;
  std::uint64_t count_open_edges(const SurfacePiece& piece) const;

  const ComponentChoice& choice_;
  const Lattice lattice_;
  const Executor& executor_;
  std::vector<std::uint8_t> front_is_kept_;  // of all vertices that the next piece inherits
  std::uint64_t triangles_ = 0;

  // Of the piece.
  Array<std::uint32_t> parents_;  // sets of connected vertices
  Array<std::uint8_t> kept_;      // per vertex
};

}  // namespace isoweave
