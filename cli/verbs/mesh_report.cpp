#include "verbs/mesh_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "isoweave/remote.hpp"
#include "options/levels.hpp"
#include "report/print.hpp"
#include "verbs/mesh_forecast.hpp"
#include "verbs/mesh_options.hpp"

namespace isoweave::cli {

void report_surface_options(Json& json, const MeshArguments& arguments, const MeshOptions& options) {
  json["inside"] = arguments.inside;
  json["closed"] = options.closed;
  json["smooth"] = options.smooth;
  json["extractor"] = arguments.extractor;
}

Json mesh_report_json(const MeshReport& report, const VolumeInfo& info, const MeshArguments& arguments,
                      const MeshOptions& options, const MeshFileOptions& file,
                      const std::optional<Forecast>& forecast) {
  const std::vector<OutputOptions> outputs = level_outputs(arguments.output, arguments.stop);
  Json input = volume_json(info, arguments.input.path);
  add_range(input, report.min, report.max, report.nan);
  Json json = run_json(report, std::move(input));
  if (forecast) {
    json["memory"]["predicted_bytes"] = forecast->peak_bytes;
    json["forecast"] = Json::parse(forecast_json(*forecast, output_bytes(*forecast, arguments, file)));
  }
  json["iso"] = options.iso;
  report_surface_options(json, arguments, options);
  json["quality"] = arguments.quality;
  json["normals"] = normals_name(options.normals);
  if (!arguments.color_by.empty()) json["color_by"] = shown_url(arguments.color_by);
  json["output"] = outputs.back().name();
  if (!report.levels.empty()) json["levels"] = levels_json(report, outputs);
  json["space"] = space_of_mesh(info.geometry, options.space);
  json["offset"] = file.offset;
  return json;
}

void print_caps(const MeshReport& report, const MeshArguments& arguments) {
  constexpr double kMuch = 0.05;
  if (!report.cap_cells || report.cells_crossed == 0 || arguments.closed) return;
  const double part = static_cast<double>(*report.cap_cells) / static_cast<double>(report.cells_crossed);
  if (part < kMuch) return;
  print_note(fmt::format(
      "closed at the border of the volume by flat caps, about {:.0f} % of the surface: --open leaves it open there",
      std::min(part, 1.0) * 100));
}

}  // namespace isoweave::cli
