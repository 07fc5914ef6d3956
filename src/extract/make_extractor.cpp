#include "extract/make_extractor.hpp"

#include "extract/dual_cubes.hpp"
#include "extract/marching_cubes.hpp"
#include "extract/marching_tetrahedra.hpp"
#include "extract/trilinear_cubes.hpp"

namespace isoweave {

std::unique_ptr<Extractor> make_extractor(ExtractorKind kind, const VolumeInfo& volume, const ExtractOptions& options,
                                          const Executor& executor) {
  switch (kind) {
    case ExtractorKind::kTrilinear:
      return std::make_unique<TrilinearCubes>(volume, options, executor);
    case ExtractorKind::kTetrahedra:
      return std::make_unique<MarchingTetrahedra>(volume, options, executor);
    case ExtractorKind::kDual:
      return std::make_unique<DualCubes>(volume, options, executor);
    case ExtractorKind::kCubes:
      break;
  }
  return std::make_unique<MarchingCubes>(volume, options, executor);
}

VertexNumbering numbering_of(ExtractorKind kind, const std::array<std::int64_t, 3>& dims) {
  switch (kind) {
    case ExtractorKind::kTrilinear:
      return VertexNumbering::of_cubes(dims);
    case ExtractorKind::kTetrahedra:
      return VertexNumbering::of_kuhn_edges(dims);
    case ExtractorKind::kDual:
      return VertexNumbering::of_dual_cubes(dims);
    case ExtractorKind::kCubes:
      break;
  }
  return VertexNumbering::of_cube_edges(dims);
}

int cells_of_triangle(ExtractorKind kind) { return kind == ExtractorKind::kDual ? 2 : 1; }

}  // namespace isoweave
