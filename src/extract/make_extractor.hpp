// The extractors by their kinds.
#pragma once

#include <memory>

#include "extract/edge_extractor.hpp"
#include "extract/extractor.hpp"
#include "isoweave/mesh_options.hpp"

namespace isoweave {

// An extractor over the slices of a volume. The executor must outlive it. Throws OverMemory for rows that are too long.
std::unique_ptr<Extractor> make_extractor(ExtractorKind kind, const VolumeInfo& volume, const ExtractOptions& options,
                                          const Executor& executor);

// How an extractor numbers its vertices.
VertexNumbering numbering_of(ExtractorKind kind, const std::array<std::int64_t, 3>& dims);

// The most cells along an axis that a triangle reaches into.
int cells_of_triangle(ExtractorKind kind);

}  // namespace isoweave
