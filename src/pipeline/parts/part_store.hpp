// The parts of a surface on their way from block to block.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lattice/vertex_numbering.hpp"
#include "pipeline/parts/block_grid.hpp"
#include "pipeline/parts/waiting_part.hpp"
#include "simplify/part_algebra.hpp"

namespace isoweave {

class PartStore {
 public:
  // The first stage takes no parts: it makes them. shape: that of all parts. folder: where parts wait in a file; empty:
  // they wait in memory.
  PartStore(std::vector<BlockGrid> grids, const VertexNumbering& numbering, PartShape shape, const std::string& folder)
      : grids_(std::move(grids)), numbering_(numbering), shape_(std::move(shape)), waiting_(grids_.size()) {
    if (!folder.empty()) scratch_.emplace(folder);
    closed_.assign(stages(), std::numeric_limits<std::int64_t>::min());
  }

  const BlockGrid& grid(std::size_t stage) const { return grids_[stage]; }
  std::size_t stages() const { return grids_.size(); }

  // Hands triangles on to the blocks of a stage, each by the point of its vertex with the smallest id. Where the layer
  // of the block is closed, a later stage gets them.
  void hand_on(ZonePart part, std::size_t stage);

  // Closes the layers of a stage below one: they take no more parts.
  void close_below(std::size_t stage, std::int64_t layer) { closed_[stage] = layer; }

  // The blocks of a layer of a stage for which there are parts, and their parts.
  std::vector<BlockIndex> blocks(std::size_t stage, std::int64_t layer) const;
  std::vector<ZonePart> take(std::size_t stage, const BlockIndex& block);
  std::vector<ZonePart> take_all();

  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t triangles() const { return triangles_; }
  std::uint64_t bytes() const;

  // Lists the labels of all parts that belong to a receipt of a level.
  void list_labels(std::size_t level, std::vector<std::uint32_t*>& labels);

 private:
  struct Address {
    std::size_t stage;
    BlockIndex block;
  };

  Address address_of(std::uint64_t id, std::size_t stage) const;
  void put(const Address& address, ZonePart part);
  void move_out(std::vector<WaitingPart>& waiting, std::vector<ZonePart>& parts);

  std::vector<BlockGrid> grids_;
  VertexNumbering numbering_;
  PartShape shape_;
  std::optional<PartScratch> scratch_;
  std::vector<std::map<BlockIndex, std::vector<WaitingPart>>> waiting_;  // per stage; blocks in the order of layers
  std::vector<std::int64_t> closed_;                                     // per stage: layers below take no more parts
  std::uint64_t vertices_ = 0;
  std::uint64_t triangles_ = 0;
};

}  // namespace isoweave
