// The report of isoweave mesh about one surface.
#pragma once

#include <optional>

#include "isoweave/forecast.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"
#include "report/report.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// Adds the options of a surface that every report of isoweave mesh has.
void report_surface_options(Json& json, const MeshArguments& arguments, const MeshOptions& options);

// forecast: of the run, if there was one.
Json mesh_report_json(const MeshReport& report, const VolumeInfo& info, const MeshArguments& arguments,
                      const MeshOptions& options, const MeshFileOptions& file, const std::optional<Forecast>& forecast);

// Says how much of the surface lies on caps, where that is much, and the option that leaves them out.
void print_caps(const MeshReport& report, const MeshArguments& arguments);

}  // namespace isoweave::cli
