#include "verbs/mesh_forecast.hpp"

#include <fmt/format.h>

#include "isoweave/error.hpp"
#include "options/input_volume.hpp"
#include "report/print.hpp"
#include "report/report.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kPageOption = "--html";

// The smallest cap that should do, as --memory takes it.
std::string cap_text(std::uint64_t bytes) { return fmt::format("{}M", (bytes + 999'999) / 1'000'000); }

// The most triangles of all levels: no level has more than the finest. Forecast only where memory depends on it.
std::uint64_t triangles_of_levels(const MeshArguments& arguments, const MeshOptions& options,
                                  const MeshFileOptions& file, const RunControl& control, const Forecast& last) {
  const bool matters = arguments.page.given() || output_memory(arguments.output, 1, 1, file) > 0;
  if (options.levels.empty() || !matters) return last.triangles;
  MeshOptions finest = options;
  finest.error = options.levels.front();
  finest.levels.clear();
  const Forecast forecast = forecast_mesh(*open_input(arguments.input), finest, control);
  return last.triangles + options.levels.size() * forecast.triangles;
}

// Adds what making the page takes after the run: the page, and before that the surface that stands in for a large one.
void add_page_memory(Forecast& forecast, std::uint64_t triangles, const MeshArguments& arguments,
                     const MeshOptions& options, const RunControl& control) {
  add_memory_after(forecast, page_memory(triangles, forecast.triangles_extracted));
  if (forecast.triangles_extracted <= kMostFullTriangles) return;
  const std::unique_ptr<SliceSource> volume = open_input(arguments.input);
  const Forecast stand_in = forecast_mesh(*volume, stand_in_options(options, volume->info()), control);
  add_memory_after(forecast, stand_in.least_bytes);
}

}  // namespace

MeshOptions stand_in_options(const MeshOptions& options, const VolumeInfo& info) {
  MeshOptions stand_in = full_surface(options);
  stand_in.space = options.space;
  stand_in.triangles = kMostFullTriangles;
  stand_in.error = Length::units(most_shape_error(info));
  return stand_in;
}

std::uint64_t output_bytes(const Forecast& forecast, const MeshArguments& arguments, const MeshFileOptions& file) {
  return output_bytes(arguments.output, forecast.vertices, forecast.triangles, file);
}

bool holds_any_surface(const MeshArguments& arguments, const MeshFileOptions& file, const VolumeInfo& volume) {
  constexpr double kPerCell = 20;  // triangles, and vertices: more than any extractor makes
  double most = kPerCell * static_cast<double>(stop_levels(arguments.stop).size());
  for (const std::int64_t samples : volume.dims) most *= static_cast<double>(samples + 1);  // closed at both ends
  constexpr double kCountable = 1e15;
  if (most > kCountable) return false;
  try {
    output_bytes(arguments.output, static_cast<std::uint64_t>(most), static_cast<std::uint64_t>(most), file);
  } catch (const CannotWrite&) {
    return false;
  }
  return true;
}

std::string forecast_text(const Forecast& forecast, std::uint64_t asked, std::uint64_t bytes, int threads,
                          bool takes_cap) {
  const bool out_of_reach = asked > 0 && forecast.triangles > asked;
  return fmt::format(
      "triangles  about {}, {} of them left{}\noutput     about {}\nmemory     about {}{}\n"
      "time       about {:.2g} s on {} thread{}\n",
      short_count(static_cast<double>(forecast.triangles_extracted)),
      short_count(static_cast<double>(forecast.triangles)),
      out_of_reach ? fmt::format(": small components and the error keep more than the {} asked for",
                                 short_count(static_cast<double>(asked)))
                   : "",
      byte_text(bytes), byte_text(forecast.peak_bytes),
      takes_cap ? ", with --memory at least " + cap_text(forecast.least_bytes) : "", forecast.seconds, threads,
      threads == 1 ? "" : "s");
}

CheckedForecast checked_forecast(const MeshArguments& arguments, const MeshOptions& options,
                                 const MeshFileOptions& file, const RunControl& control) {
  Forecast forecast = forecast_mesh(*open_input(arguments.input), options, control);
  output_bytes(forecast, arguments, file);
  const std::uint64_t triangles = triangles_of_levels(arguments, options, file, control, forecast);
  const std::uint64_t files = output_memory(arguments.output, triangles / 2, triangles, file);
  add_memory_during(forecast, files + watch_memory(arguments.watch));
  const std::uint64_t of_run = forecast.least_bytes;
  if (arguments.page.given()) add_page_memory(forecast, triangles, arguments, options, control);
  const bool page_decides = forecast.least_bytes > of_run;
  require_memory(forecast, control.memory, arguments.input.path, page_decides ? kPageOption : "");
  return {forecast, files};
}

void check_page_memory(const MeshArguments& arguments, std::uint64_t cap, std::uint64_t triangles,
                       std::uint64_t triangles_before) {
  if (!arguments.page.given()) return;
  Forecast of_page;
  add_memory_after(of_page, page_memory(triangles, triangles_before));
  require_memory(of_page, cap, arguments.input.path, kPageOption);
}

void check_finer(const MeshArguments& arguments, const MeshOptions& options, const MeshFileOptions& file,
                 const RunControl& control, const Forecast& last) {
  Forecast sum;
  if (arguments.output.one_file) sum = last;
  for (const Length& error : options.levels) {
    MeshOptions level = options;
    level.error = error;
    level.levels.clear();
    const Forecast forecast = forecast_mesh(*open_input(arguments.input), level, control);
    sum.vertices += forecast.vertices;
    sum.triangles += forecast.triangles;
    output_bytes(sum, arguments, file);
    if (!arguments.output.one_file) return;
  }
}

}  // namespace isoweave::cli
