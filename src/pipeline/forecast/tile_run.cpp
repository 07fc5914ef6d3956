#include "pipeline/forecast/tile_run.hpp"

#include <array>
#include <memory>

#include "output/world.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/volume_sweep.hpp"

namespace isoweave {

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
