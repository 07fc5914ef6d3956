// The run that simplifies a tile, and counts what it removes.
#pragma once

#include "isoweave/mesh.hpp"
#include "isoweave/mesh_options.hpp"
#include "isoweave/report.hpp"
#include "isoweave/run.hpp"
#include "pipeline/forecast/forecast_tile.hpp"
#include "simplify/cost_histogram.hpp"

namespace isoweave {

// The options of a run for a part of its volume: the open surface up to an error, with nothing that changes no count.
MeshOptions tile_options(const MeshOptions& options, double error);

struct TileRun {
  MeshReport report;
  CostHistogram removed;  // triangles, by the costs of the collapses
};

// Simplifies a tile to the error of the options. Of the control threads, slab and stop count.
TileRun simplify_tile(Tile& tile, MeshSink& sink, const MeshOptions& options, const RunControl& control);

}  // namespace isoweave
