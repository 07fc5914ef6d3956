// A pass over a surface in blocks: stage after stage, until every triangle has been found final.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "isoweave/blocks.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/block_worker.hpp"
#include "pipeline/parts/part_store.hpp"

namespace isoweave {

class BlockPass {
 public:
  // Is told of each layer of blocks of the volume.
  using Tell = std::function<void(SlabRecord& record)>;

  // limit: edges with a higher cost are not decided. store: where parts wait. take_final: as of a worker. All other
  // arguments must outlive the pass.
  BlockPass(const Task& task, CostBits limit, const BlockStages& stages, PartStore& store, const RunControl& control,
            const Executor& executor, MeshReport& report, BlockWorker::TakeFinal take_final);

  // Passes over the surface of a volume, which is opened for each block.
  void extract(const VolumeOpener& open, const Tell& tell);

  // Passes over the parts that wait for the first stage.
  void take_parts();

  const BlockTotals& totals() const { return worker_.totals(); }

 private:
  using FirstLayer = std::function<void(std::int64_t layer)>;

  void finish_layers(std::size_t stage, std::int64_t plane, const FirstLayer& first);
  void finish_all(const FirstLayer& first);
  void extract_layer(const VolumeOpener& open, std::int64_t layer, SlabRecord& record);
  void extract_block(const VolumeOpener& open, const CellBox& cells, SlabRecord& record);
  void take_layer(std::size_t stage, std::int64_t layer);
  void finish_block(std::size_t stage, ZonePart rest);

  const Task& task_;
  const BlockStages& stages_;
  const RunControl& control_;
  MeshReport& report_;
  PartStore& store_;
  BlockWorker worker_;
  std::vector<std::int64_t> next_layer_;  // per stage
};

}  // namespace isoweave
