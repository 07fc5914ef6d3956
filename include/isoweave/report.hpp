// The report of a run and of the meshes that it has written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "isoweave/run.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// A surface as it was written.
struct SurfaceReport {
  // In the volume's unit: the error that was asked for. Where a number of triangles was asked for, it is the largest
  // error of a collapse as it was made, or 0 if there was none.
  double error = 0;
  std::uint64_t triangles = 0, vertices = 0;
  // Non-manifold edges and vertices are counted around vertices that have become final. The unsimplified surface of a
  // volume has none by construction, so it is not searched for them.
  std::uint64_t open_edges = 0, nonmanifold_edges = 0, nonmanifold_vertices = 0, components = 0;
  std::int64_t euler = 0;
  std::uint64_t digest = 0;
};

// The amounts that a run has not read, as an index told that the surface lies elsewhere.
struct LeftOutReport {
  // Chunks of Zarr, N5 and HDF5, strips and tiles of TIFF; 0 of other formats.
  std::uint64_t chunks = 0, chunks_left_out = 0;
  std::uint64_t bytes_left_out = 0;  // of samples as they are in memory
};

// A stage of a run in blocks.
struct BlockStage {
  std::int64_t size = 0;        // of its blocks, in cells
  std::uint64_t blocks = 0;     // that had triangles
  std::uint64_t triangles = 0;  // taken in: extracted in the first stage, undecided ones later
};

// The work of a rank.
struct RankWork {
  std::uint64_t tasks = 0;      // blocks of all stages
  std::uint64_t triangles = 0;  // taken in: extracted, or undecided ones
  std::uint64_t messages = 0, bytes_sent = 0;
  double seconds_waiting = 0;    // for messages, with nothing to do
  std::uint64_t peak_bytes = 0;  // of the process, as the system counts it
};

// The cells of a preview (preview.hpp), and how far its vertices are from what they stand for.
struct PreviewReport {
  double cell = 0;  // side, in the volume's or mesh's unit
  // The root of the mean square distance of the vertices from the planes of the triangles that had a corner in their
  // cells, by area. It says nothing of parts that have vanished.
  double plane_rms = 0;
  std::uint64_t cells = 0;      // that the full surface has vertices in; those without a triangle have no vertex
  std::uint64_t collapsed = 0;  // triangles that had two corners in one cell
  std::uint64_t repeated = 0;   // triangles with the same three cells, in the same direction, as another one
};

// The report of a run, and of its mesh with the largest error.
struct MeshReport : SurfaceReport {
  int threads = 0;
  std::int64_t slab = 0;
  Schedule schedule = Schedule::kQueue;
  Device device = Device::kCpu;
  double min = 0, max = 0;  // values read; min > max when all were NaN
  std::uint64_t nan = 0;    // samples
  // Of the crossed cells, about so many that belong to caps; nothing where it is not counted: in an open volume,
  // without measuring, in blocks, and of one of several surfaces.
  std::optional<std::uint64_t> cap_cells{};
  std::uint64_t cells_crossed = 0, triangles_extracted = 0, vertices_extracted = 0;
  std::uint64_t collapses = 0, postponed = 0, rekeyed = 0, rounds = 0;
  std::uint64_t specks = 0;  // components dropped
  std::uint64_t target = 0;  // the number of triangles that was asked for, also as a share; 0: none
  // Dropped by SurfaceOptions::components. Their triangles are among those extracted. `specks` are not among them.
  std::uint64_t components_dropped = 0, triangles_dropped = 0;
  std::vector<SurfaceReport> levels;  // finer meshes, as MeshOptions::levels
  std::uint64_t locked_vertices = 0;  // simplify_mesh only: left in place, non-manifold or badly oriented
  std::int64_t resumed_at = 0;        // layers that an earlier process has done
  // Seconds by the clock. Finer levels are handed to their sinks while simplifying.
  double seconds_read = 0, seconds_extract = 0, seconds_simplify = 0, seconds_write = 0, seconds_total = 0;
  std::uint64_t peak_bytes = 0;             // of the process, as the system counts it
  std::optional<LeftOutReport> left_out{};  // where the run had an index
  std::vector<BlockStage> blocks;           // of a run in blocks; else none
  std::vector<RankWork> ranks;              // of a run by ranks; else none
  std::optional<PreviewReport> preview{};   // of a preview
  std::vector<SlabRecord> sweep;            // in blocks: one for each layer of blocks
  std::vector<std::string> warnings;        // one line each
};

}  // namespace isoweave
#pragma GCC visibility pop
