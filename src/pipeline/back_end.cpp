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
  return shape;
}

}  // namespace isoweave
