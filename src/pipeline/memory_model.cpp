#include "pipeline/memory_model.hpp"

#include "simplify/normal_quadric.hpp"

namespace isoweave {

VertexExtras vertex_extras(const AttributeOptions& attributes) {
  VertexExtras extras;
  if (attributes.normals != Normals::kAbsent) extras.extracted += sizeof(Point);
  if (attributes.values != nullptr) extras.extracted += sizeof(float);
  extras.held = extras.extracted + (attributes.normals == Normals::kQuadric ? sizeof(NormalQuadric) : 0);
  if (attributes.values != nullptr) extras.slice_bytes = attributes.values->info().slice_bytes();
  return extras;
}

}  // namespace isoweave
