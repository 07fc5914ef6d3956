// The stage that drops components that are not kept, before any later part of the loop sees them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "extract/piece_stage.hpp"
#include "isoweave/components.hpp"
#include "lattice/vertex_numbering.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

class ComponentFilter final : public PieceStage {
 public:
  // path: of the volume, for messages. The choice must outlive the filter.
  ComponentFilter(const ComponentChoice& choice, const VertexNumbering& numbering, std::string path,
                  const Executor& executor)
      : choice_(choice), numbering_(numbering), path_(std::move(path)), executor_(executor) {}

  // Takes the dropped components out of the next piece. The rest keeps its order, as if there had never been more.
  // Throws BadInput, and changes nothing, when a component is kept in part: the choice belongs to another surface then.
  void apply(SurfacePiece& piece) override;

  std::uint64_t triangles() const { return triangles_; }  // kept so far

  std::optional<std::uint64_t> inherited(std::uint64_t before) const override;
  void serialize(StateWriter& state) const override;
  void serialize(StateReader& state) override;

  // Throws BadInput: the surface is not the one that components were chosen in.
  [[noreturn]] void refuse() const;

 private:
  void find_parts(const SurfacePiece& piece);
  void judge_parts(const SurfacePiece& piece);
  bool agrees_with_front() const;
  void drop(SurfacePiece& piece) const;
  bool keeps_seed(std::uint64_t id) const;
  std::uint64_t count_open_edges(const SurfacePiece& piece) const;

  const ComponentChoice& choice_;
  const VertexNumbering numbering_;
  const std::string path_;
  const Executor& executor_;
  std::vector<std::uint8_t> front_is_kept_;  // of all vertices that the next piece inherits
  std::uint64_t triangles_ = 0;

  // The vertices of the piece.
  Array<std::uint32_t> parents_;  // sets of connected vertices
  Array<std::uint8_t> kept_;      // per vertex
};

}  // namespace isoweave
