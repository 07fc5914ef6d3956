#include "mesh_forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "isoweave/error.hpp"
#include "output.hpp"
#include "pipeline/memory_cap.hpp"
#include "pipeline/sweep.hpp"
#include "report.hpp"

namespace isoweave::cli {

std::uint64_t output_bytes(const Forecast& forecast, const MeshArguments& arguments, const MeshFileOptions& file) {
  return output_bytes(arguments.output, forecast.vertices, forecast.triangles, file);
}

std::string forecast_text(const Forecast& forecast, std::uint64_t asked, std::uint64_t bytes, int threads) {
  const bool out_of_reach = asked > 0 && forecast.triangles > asked;
  return fmt::format(
      "triangles  about {}, {} of them left{}\noutput     about {}\nmemory     about {}, with --memory at least {}\n"
      "time       about {:.2g} s on {} thread{}\n",
      short_count(static_cast<double>(forecast.triangles_extracted)),
      short_count(static_cast<double>(forecast.triangles)),
      out_of_reach ? fmt::format(": small components and the error keep more than the {} asked for",
                                 short_count(static_cast<double>(asked)))
                   : "",
      byte_text(bytes), byte_text(forecast.peak_bytes), cap_text(whole_cap(forecast.least_bytes)), forecast.seconds,
      threads, threads == 1 ? "" : "s");
}

Forecast checked_forecast(const MeshArguments& arguments, const MeshOptions& options, const MeshFileOptions& file,
                          const RunControl& control) {
  Forecast forecast = forecast_mesh(*open_input(arguments.input), options, control);
  output_bytes(forecast, arguments, file);
  const std::uint64_t beside =
      output_memory(arguments.output, forecast.vertices, forecast.triangles, file) + watch_memory(arguments.watch);
  forecast.peak_bytes += beside;
  forecast.least_bytes += beside;
  // A run with that cap looks at the volume, too.
  forecast.least_bytes = std::max(forecast.least_bytes, with_slack(peak_process_bytes()));
  if (control.memory > 0 && without_slack(forecast.least_bytes) > control.memory) {
    refuse_cap(arguments.input.path, forecast.least_bytes, control.memory);
  }
  return forecast;
}

void check_page_memory(const MeshArguments& arguments, std::uint64_t cap, std::uint64_t triangles) {
  if (!arguments.page.given() || cap == 0 || page_memory(triangles) <= cap) return;
  throw OverMemory(fmt::format("{}: expected --memory {:.0f}M or more for --html, found {}", arguments.input.path,
                               std::ceil(static_cast<double>(page_memory(triangles)) * 1e-6), arguments.memory));
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

std::uint64_t memory_beside_watch(const MeshArguments& arguments, std::uint64_t cap) {
  const std::uint64_t held = watch_memory(arguments.watch);
  if (held < cap) return cap - held;
  throw OverMemory(fmt::format("{}: expected more than --memory {:.0f}M for --watch, found {}", arguments.input.path,
                               static_cast<double>(held) * 1e-6, arguments.memory));
}

}  // namespace isoweave::cli
