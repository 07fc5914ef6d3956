// A worker on blocks: it extracts the surface of a block or takes parts in, decides, and hands over final triangles.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "pipeline/parts/block_pieces.hpp"
#include "simplify/part_algebra.hpp"
#include "simplify/simplifier.hpp"

namespace isoweave {

// The counts of all blocks worked on.
struct BlockTotals {
  DecisionCounts decisions;
  std::uint64_t rounds = 0;
  std::uint64_t triangles = 0;          // of the last block, taken in
  std::vector<SurfaceDefects> defects;  // per level
  SampleRange range;
  CostHistogram removed;  // triangles by key, in a run to a number of triangles

  void operator+=(const BlockTotals& other);
};

class BlockWorker {
 public:
  // Is told that a level has triangles that are final: they leave through simplifier.final_source(level).
  using TakeFinal = std::function<void(Simplifier& simplifier, std::size_t level)>;

  // limit: edges with a higher cost are not decided. report: gets the counts of extraction, and times. All arguments
  // must outlive the worker.
  BlockWorker(const Task& task, CostBits limit, const CellBox& all, const RunControl& control, const Executor& executor,
              MeshReport& report, TakeFinal take_final);

  // Works on a block of cells, whose volume has been opened for it. Returns what is undecided then. held: bytes that
  // others hold. Notes the largest counts in the record.
  ZonePart extract(std::unique_ptr<SliceSource> volume, const CellBox& cells, std::uint64_t held, SlabRecord& record);

  // Works on parts that meet in a block. Returns what is undecided then.
  ZonePart glue(std::vector<ZonePart> parts);

  const BlockTotals& totals() const { return totals_; }

 private:
  bool is_without_surface(const SliceSource& volume, const CellBox& cells);
  std::unique_ptr<Simplifier> make_simplifier() const;
  void decide(Simplifier& simplifier);
  template <class IsBorder>
  ZonePart rest_of(Simplifier& simplifier, const IsBorder& is_border);

  const Task& task_;
  const CostBits limit_;
  const CellBox all_;
  const RunControl& control_;
  const Executor& executor_;
  MeshReport& report_;
  TakeFinal take_final_;
  BlockTotals totals_;
};

}  // namespace isoweave
