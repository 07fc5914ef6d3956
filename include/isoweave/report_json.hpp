// Facts about volumes, runs and meshes as JSON: what reports are made of, for the command line, for the C interface and
// for programs that write reports of their own.
//
// Each function returns the text of one JSON object on one line, in UTF-8. Bytes of names that are no UTF-8 become
// U+FFFD. A number that JSON has none for is null. Lengths are in the unit of the volume or mesh, and seconds by the
// clock. A key keeps its name and its meaning; later versions may have more keys.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "isoweave/forecast.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/report.hpp"
#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// The facts of a volume's header.
std::string volume_json(const VolumeInfo& info);

// The least and the greatest value, null where min > max, and the number of samples that are NaN.
std::string range_json(double min, double max, std::uint64_t nan);

// A surface as it was written.
std::string surface_json(const SurfaceReport& surface);

// The facts of a run: its counts, times and memory, and its surface. `input` is an empty object, for the facts of the
// volume or mesh. Finer levels have a surface_json each, which is not in it.
std::string run_json(const MeshReport& report);

// The counts and warnings of one mesh of a run that makes several. Its surface is not in it.
std::string counts_json(const MeshReport& report);

// A forecast. output_bytes: the size of the files, where that is known.
std::string forecast_json(const Forecast& forecast, std::optional<std::uint64_t> output_bytes = {});

// The facts of a mesh, by its triangles alone. path: the file that it comes from, if there is one.
std::string check_json(const MeshCheck& check, std::optional<std::string_view> path = {});

std::string self_intersections_json(const SelfIntersections& found);

// Distances between two meshes A and B. unit: the length that they are multiples of.
// @pre unit > 0
std::string distances_json(const MeshDistance& distance, double unit = 1);

}  // namespace isoweave
#pragma GCC visibility pop
