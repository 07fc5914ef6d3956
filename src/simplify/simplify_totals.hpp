// The counts of a simplification.
#pragma once

#include <cstdint>

#include "parallel/annotations.hpp"

namespace isoweave {

struct DecisionCounts {
  std::uint64_t collapses = 0;
  std::uint64_t postponed = 0;  // decided, and illegal at the time
  std::uint64_t rekeyed = 0;    // decided, and dearer than the key said
  std::uint64_t removed = 0;    // triangles
  std::uint64_t specks = 0;     // tetrahedra that have vanished
  std::uint64_t dearest = 0;    // the largest cost of a collapse as it was made, as CostBits

  ISOWEAVE_HD void note_cost(std::uint64_t cost) { dearest = cost > dearest ? cost : dearest; }

  ISOWEAVE_HD void operator+=(const DecisionCounts& other) {
    collapses += other.collapses;
    postponed += other.postponed;
    rekeyed += other.rekeyed;
    removed += other.removed;
    specks += other.specks;
    note_cost(other.dearest);
  }
};

// The defects that final vertices show while their stars are whole for the last time.
struct SurfaceDefects {
  std::uint64_t nonmanifold_edges = 0;
  std::uint64_t nonmanifold_vertices = 0;

  void operator+=(const SurfaceDefects& other) {
    nonmanifold_edges += other.nonmanifold_edges;
    nonmanifold_vertices += other.nonmanifold_vertices;
  }
};

// The counts of an unfinished simplification, as they are saved.
struct SimplifierCounts {
  DecisionCounts decisions;
  std::uint64_t rounds = 0;
  std::uint64_t appended = 0;  // triangles
  std::uint64_t dropped = 0;   // triangles that have been handed over

  std::uint64_t held() const { return appended - decisions.removed - dropped; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive.value(decisions);
    archive.value(rounds);
    archive.value(appended);
    archive.value(dropped);
  }
};

}  // namespace isoweave
