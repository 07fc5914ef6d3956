#include "pipeline/forecast/tile_run.hpp"

#include <array>
#include <memory>

#include "output/world.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/volume_sweep.hpp"

namespace isoweave {

MeshOptions tile_options(const MeshOptions& options, double error) {
  MeshOptions of_tile = options;
  of_tile.closed = false;
  if (options.normals == Normals::kGradient) of_tile.normals = Normals::kAbsent;
  of_tile.values.reset();
  of_tile.levels.clear();
  of_tile.triangles = 0;
  of_tile.share = 0;
  of_tile.components.reset();
  of_tile.space = OutputSpace::kIndex;
  of_tile.error = Length::units(error);
  return of_tile;
}

TileRun simplify_tile(Tile& tile, MeshSink& sink, const MeshOptions& options, const RunControl& control) {
  TileRun run;
  const Task task = resolve(tile.info(), options, control);
  const World world(task.volume.geometry, task.space);
  VolumeSweep sweep(tile, task, control, run.report);
  const std::unique_ptr<Extractor> extractor = sweep.make_extractor();
  MeshSink* const sinks[] = {&sink};
  HostBackEnd back_end(task.simplify, world, sinks, sweep.executor(), control, control.stop.get());
  back_end.count_removed();
  sweep.begin(*extractor, {}, &back_end);
  sweep.open();
  while (!sweep.complete()) sweep.step();
  sweep.loop().wait_for_sinks();
  sweep.finish();
  run.removed = back_end.removed_by_key();
  return run;
}

}  // namespace isoweave
