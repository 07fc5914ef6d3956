#include "pipeline/back_end.hpp"

namespace isoweave {

void require_kind(StateReader& state, bool simplified) {
  std::uint8_t saved = 0;
  state.value(saved);
  state.require(saved == std::uint8_t{simplified},
                simplified ? "a surface that is simplified" : "an extracted surface");
}

PartShape part_shape(const SimplifyTask& task) {
  PartShape shape;
  shape.normals = task.normals;
  shape.normal_quadrics = task.zone.normals_count;
  shape.values = task.values;
  shape.retire = task.zone.retire;
  // A vertex may leave the volume by a little. In numbers as large as these, searches still end.
  constexpr double kFar = 1 << 20;
  const VertexNumbering& numbering = task.zone.numbering;
  const auto& dims = numbering.lattice.dims;
  shape.end_id = numbering.id(dims[0], dims[1], dims[2], numbering.slots);
  const auto far = [&](std::size_t n, double cell) { return kFar * static_cast<double>(dims[n] + 2) * cell; };
  shape.farthest = {far(0, task.zone.cell.x), far(1, task.zone.cell.y), far(2, task.zone.cell.z)};
  return shape;
}

}  // namespace isoweave
