// Runs by ranks of one process.
#pragma once

#include <gtest/gtest.h>

#include <exception>
#include <span>
#include <utility>
#include <vector>

#include "block_scenes.hpp"
#include "isoweave/ranks.hpp"
#include "local_ranks.hpp"

namespace isoweave::testing {

inline void rethrow_first(const std::vector<std::exception_ptr>& errors) {
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

// Meshes a scene by ranks. Others than rank 0 have no sinks.
inline BlockRun run_ranks(const BlockScene& scene, int count, const RankOptions& ranks, const RunControl& control) {
  return run_into_memory(scene, [&](std::span<MeshSink* const> sinks) {
    MeshReport report;
    rethrow_first(LocalRanks(count).run([&](RankLink& link) {
      const bool first = link.rank() == 0;
      MeshReport own =
          mesh_in_ranks(scene.open, first ? sinks : std::span<MeshSink* const>(), scene.options, ranks, link, control);
      if (first) report = std::move(own);
    }));
    EXPECT_EQ(report.ranks.size(), static_cast<std::size_t>(count));
    // Each rank has said at its end what it did.
    for (const RankWork& rank : report.ranks) EXPECT_GT(rank.peak_bytes, 0U);
    return report;
  });
}

}  // namespace isoweave::testing
