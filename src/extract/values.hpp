// Values of another volume at the vertices of a surface.
#pragma once

#include <array>

#include "extract/surface_piece.hpp"
#include "lattice/vertex_numbering.hpp"
#include "parallel/parallel.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// Gives the new vertices of a piece whose vertices lie on edges of the lattice the values between the two samples of
// their edges, as numbers that slope and intercept make of samples. Where one of the two is NaN or past the border the
// other one counts; where both are, the value is NaN. The window holds the slices of the piece.
void sample_values(const SliceWindow& window, const VertexNumbering& numbering, const std::array<double, 3>& spacing,
                   const Executor& executor, SurfacePiece& piece);

}  // namespace isoweave
