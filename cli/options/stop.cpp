#include "options/stop.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <vector>

#include "options/values.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

constexpr std::string_view kInfinite = "inf";  // an error without a bound

// The bounds that were asked for beside a number of triangles: any of them may have stopped a run before.
std::string bounds_given(const StopOptions& stop) {
  std::vector<std::string> bounds;
  if (!stop.error.empty() && stop.error != kInfinite) bounds.push_back("--error " + stop.error);
  if (!stop.max_distance.empty()) bounds.push_back("--max-distance " + stop.max_distance);
  return fmt::format("{}", fmt::join(bounds, " or "));
}

}  // namespace

void add_stop_options(CLI::App& verb, StopOptions& stop) {
  verb.add_option(
      "--error", stop.error,
      "How far the surface may move, typically (RMS); the largest distance may be several times that, see "
      "--max-distance. In vox, mm, um, nm, in, the unit of the input, or % of the diagonal of its box (that of the "
      "volume, of the mesh); 0: no simplification; inf, beside --max-distance or a number: no bound");
  CLI::Option* const triangles =
      verb.add_option("--triangles", stop.triangles,
                      "Stop at so many triangles, or earlier at --error (without it: at a twentieth of the diagonal)");
  verb.add_option("--ratio", stop.ratio, "Stop at this part of all triangles, such as 10%")->excludes(triangles);
  CLI::Option* lods =
      verb.add_option("--lods", stop.lods,
                      "Several errors E1,E2,... in one sweep: -o a.ply makes a_lod0.ply (the finest), a_lod1.ply, ...")
          ->excludes("--error", "--triangles", "--ratio");
  if (verb.get_option_no_throw("--to-stdout") != nullptr) lods->excludes("--to-stdout");
  verb.add_option("--max-distance", stop.max_distance,
                  "Guarantee: no point of the result is farther than this length from the full surface");
  verb.add_option("--specks", stop.specks, "drop: remove closed pieces that are smaller than the error; or keep")
      ->capture_default_str();
}

Length stop_error(const StopOptions& stop, const std::string& usual, const LengthBasis& basis) {
  if (stop.has_levels()) return parse_error_length("--lods", stop_levels(stop).back().error, basis);
  if (stop.error.empty() && !stop.max_distance.empty() && !stop.has_number()) return stop_distance(stop, basis);
  const bool bounded = stop.has_number() || !stop.max_distance.empty();
  if (stop.error == kInfinite && !bounded) {
    wrong_value("--error", "a length, or inf beside --max-distance or a number", stop.error);
  }
  const bool infinite = stop.error == kInfinite || (stop.error.empty() && stop.has_number());
  if (infinite) return Length::units(std::numeric_limits<double>::infinity());
  return parse_error_length("--error", stop.error.empty() ? usual : stop.error, basis);
}

std::vector<StopOptions> stop_levels(const StopOptions& stop) {
  if (!stop.has_levels()) return {stop};
  std::vector<StopOptions> levels;
  std::istringstream errors(stop.lods + ",");
  for (std::string error; std::getline(errors, error, ',');)
    levels.push_back({error, "", "", stop.specks, "", stop.max_distance});
  return levels;
}

std::vector<GivenLength> given_lengths(const StopOptions& stop) {
  std::vector<GivenLength> lengths{{"--max-distance", stop.max_distance}};
  for (const StopOptions& level : stop_levels(stop)) {
    if (level.error != kInfinite) lengths.push_back({stop.has_levels() ? "--lods" : "--error", level.error});
  }
  return lengths;
}

bool drops_specks(const StopOptions& stop) {
  return parse_choice<bool>("--specks", stop.specks, {{"keep", false}, {"drop", true}});
}

Length stop_distance(const StopOptions& stop, const LengthBasis& basis) {
  if (stop.max_distance.empty()) return {};
  return parse_positive_length("--max-distance", stop.max_distance, basis);
}

void set_number(const StopOptions& stop, SimplifyOptions& options) {
  if (!stop.triangles.empty()) {
    options.triangles = static_cast<std::uint64_t>(parse_count("--triangles", stop.triangles));
  }
  if (stop.ratio.empty()) return;
  options.share = parse_share("--ratio", stop.ratio);
  if (!(options.share > 0 && options.share <= 1))
    wrong_value("--ratio", "a number above 0 and not above 1", stop.ratio);
}

void print_target(const StopOptions& stop, const MeshReport& report, const Length& allowed, const std::string& unit) {
  if (report.target == 0) return;
  const auto text = [&](double length) { return fmt::format("{:.4g} {}", length, unit_text(unit)); };
  print_note(
      fmt::format("error reached: {} (of the last collapses; most of the surface moved far less)", text(report.error)));
  if (report.triangles <= report.target) return;
  const bool all_tetrahedra = report.open_edges == 0 && report.triangles <= 4 * report.components;
  const std::string bounds = bounds_given(stop);
  if (!bounds.empty() && !all_tetrahedra) {
    print_note(
        fmt::format("stopped by {} at {} of {} triangles", bounds, grouped(report.triangles), grouped(report.target)));
  }
  std::vector<std::string> ways{"--largest, --min-component N or --specks drop where small components keep them"};
  if (std::isfinite(allowed.value)) {
    const std::string error = allowed.in_voxels ? fmt::format("{:.4g}vox", allowed.value) : text(allowed.value);
    ways.push_back("an --error above " + error);
  }
  if (!stop.max_distance.empty()) ways.push_back("a --max-distance above " + stop.max_distance);
  print_note(fmt::format("to leave fewer: {}", fmt::join(ways, ", or ")));
}

std::string stop_text(const StopOptions& stop, const std::string& usual) {
  const std::string more = (stop.max_distance.empty() ? "" : " distance within " + stop.max_distance) +
                           (drops_specks(stop) ? " specks drop" : "");
  const std::string& otherwise = stop.max_distance.empty() ? usual : stop.max_distance;
  if (!stop.has_number()) return "error " + (stop.error.empty() ? otherwise : stop.error) + more;
  const std::string number = stop.ratio.empty()
                                 ? fmt::format("triangles {}", parse_count("--triangles", stop.triangles))
                                 : "ratio " + stop.ratio;
  return (stop.error.empty() ? "" : "error " + stop.error + " ") + number + more;
}

}  // namespace isoweave::cli
