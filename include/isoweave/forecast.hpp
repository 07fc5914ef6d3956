// Forecasts: what a run will take, told by a part of the volume before the run.
#pragma once

#include <cstdint>
#include <string>

#include "isoweave/mesh_options.hpp"
#include "isoweave/run.hpp"
#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// The forecast of a run, from a sample of the volume.
struct Forecast {
  std::uint64_t triangles_extracted = 0;
  std::uint64_t triangles = 0, vertices = 0;  // written
  std::uint64_t peak_bytes = 0;               // of the process
  std::uint64_t least_bytes = 0;              // the smallest RunControl::memory that should do
  // Of a run to a number of triangles that can be made twice: the smallest RunControl::memory with which one sweep
  // should do. With less the run has to count first (RunControl::count_first). 0: it is made in one sweep.
  std::uint64_t least_bytes_at_once = 0;
  std::uint64_t surface_bytes = 0;  // the part of peak_bytes that the surface takes: its slab and zone
  // Of a run to a number of triangles: an error that is expected to leave clearly more of them, in the unit of the
  // volume (RunControl::head_start). 0: none is known.
  double head_start = 0;
  double seconds = 0;  // of mesh_volume on this machine, once the volume can be read fast enough
};

// Forecasts a run. Reads slices at up to 24 places, extracts the surface between them and simplifies a part of it, in a
// small part of the time of the run. Dropped components are not known here: triangles and vertices are upper bounds
// then. A source can be read once only, so this one is of no use afterwards. Where skipping slices means decompressing
// them, only the first half gigabyte is looked at. With RunControl::index these places are weighed by the bricks of the
// whole volume that the surface crosses, and what the surface misses is not read.
// @throws what mesh_volume throws
// @determinism All fields but `seconds`.
Forecast forecast_mesh(SliceSource& volume, const MeshOptions& options, const RunControl& control = {});

// Adds the forecast of another iso-value of the same volume to that of a run of mesh_iso_values, which begins with an
// empty one. Slices and the program are in memory once, and zones of all values; triangles and times add up. Runs with
// several values have no cap on memory: least_bytes is what they are expected to take.
void add_iso_value(Forecast& sum, const Forecast& value);

// Adds memory that the process holds during the run beside it to the forecast: what sinks hold (mesh_file_memory), and
// observers. The same bytes belong into RunControl::memory_elsewhere. The peak of the process until now counts as well,
// as a run with a cap is forecast in the same process.
void add_memory_during(Forecast& forecast, std::uint64_t bytes);

// Adds a job that the same process does after the run, and during which it holds so many bytes in all, to
// `least_bytes`. `peak_bytes` stays that of the run.
void add_memory_after(Forecast& forecast, std::uint64_t bytes);

// Refuses a cap on memory (RunControl::memory) that a run of this forecast will not keep. The cap that the message
// names is larger than the smallest one that is let through: the forecast is a guess, and the named cap must do.
// `where` begins the message, and `purpose` names the job that needs the memory, where that is not the run.
// @throws OverMemory "WHERE: expected --memory 151M or more, found 150M (for PURPOSE)"
void require_memory(const Forecast& forecast, std::uint64_t cap, const std::string& where,
                    const std::string& purpose = {});

// Refuses a cap on memory that a run would not keep even while it reads the volume. Reads nothing, where forecast_mesh
// reads a part.
// @throws OverMemory; BadInput and std::invalid_argument for a volume that mesh_volume refuses as well
void require_memory_to_read(SliceSource& volume, const MeshOptions& options, const RunControl& control);

}  // namespace isoweave
#pragma GCC visibility pop
