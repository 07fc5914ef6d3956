// The forecast of a run of isoweave mesh, and the limits that are known before it starts.
#pragma once

#include <cstdint>
#include <string>

#include "isoweave/forecast.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// The size of the file that is forecast. Throws CannotWrite where its format cannot hold the counts.
std::uint64_t output_bytes(const Forecast& forecast, const MeshArguments& arguments, const MeshFileOptions& file);

// asked: the number of triangles to stop at, or 0. takes_cap: whether the run goes with --memory.
std::string forecast_text(const Forecast& forecast, std::uint64_t asked, std::uint64_t bytes, int threads,
                          bool takes_cap = true);

// Whether the output can hold all triangles that the volume may have, so that their number needs no forecast.
bool holds_any_surface(const MeshArguments& arguments, const MeshFileOptions& file, const VolumeInfo& volume);

struct CheckedForecast {
  Forecast run;
  std::uint64_t files = 0;  // bytes that writing holds
};

// The forecast of the run. Refuses runs that are known to fail. `volume` must be an opening of its own, as a volume can
// be read once.
CheckedForecast checked_forecast(const MeshArguments& arguments, const MeshOptions& options,
                                 const MeshFileOptions& file, const RunControl& control);

// The options of the run that makes what stands in for the surface before simplification where a page cannot hold it.
MeshOptions stand_in_options(const MeshOptions& options, const VolumeInfo& info);

// Throws OverMemory where a page for so many triangles, of a surface that had so many before, does not fit into the
// cap.
void check_page_memory(const MeshArguments& arguments, std::uint64_t cap, std::uint64_t triangles,
                       std::uint64_t triangles_before);

// Checks the file of the finest level, or of all levels in one; refuses counts that its format cannot hold. `last`: the
// forecast of the coarsest level.
void check_finer(const MeshArguments& arguments, const MeshOptions& options, const MeshFileOptions& file,
                 const RunControl& control, const Forecast& last);

}  // namespace isoweave::cli
