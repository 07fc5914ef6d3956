#include "verbs/mesh_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/histogram.hpp"
#include "isoweave/remote.hpp"
#include "options/input_volume.hpp"
#include "options/lengths.hpp"
#include "options/levels.hpp"
#include "options/values.hpp"
#include "report/report.hpp"
#include "report/suggestions.hpp"
#include "verbs/mesh_isos.hpp"

namespace isoweave::cli {
namespace {

Normals parse_normals(std::string_view text) {
  if (text == "auto") return Normals::kAbsent;  // until the format is known
  return parse_choice<Normals>(
      "--normals", text,
      {{"none", Normals::kAbsent}, {"gradient", Normals::kGradient}, {"quadric", Normals::kQuadric}});
}

OutputSpace parse_space(std::string_view text) {
  if (text.empty()) return OutputSpace::kAsVolume;
  return parse_choice<OutputSpace>(
      "--space", text, {{"lps", OutputSpace::kLps}, {"ras", OutputSpace::kRas}, {"index", OutputSpace::kIndex}});
}

ExtractorKind parse_extractor(std::string_view text) {
  return parse_choice<ExtractorKind>("--extractor", text,
                                     {{"cubes", ExtractorKind::kCubes},
                                      {"trilinear", ExtractorKind::kTrilinear},
                                      {"tetrahedra", ExtractorKind::kTetrahedra},
                                      {"dual", ExtractorKind::kDual}});
}

// Passes of --smooth, 0 where it is not given.
int parse_smooth(std::string_view text) {
  if (text.empty()) return 0;
  const std::int64_t passes = parse_count("--smooth", text, "10");
  if (passes > kMostSmoothing) wrong_value("--smooth", fmt::format("at most {} passes", kMostSmoothing), text);
  return static_cast<int>(passes);
}

const HounsfieldPreset* find_preset(std::string_view name) {
  for (const HounsfieldPreset& preset : hounsfield_presets()) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

double parse_iso(std::string_view text) {
  if (const HounsfieldPreset* preset = find_preset(text)) return preset->iso;
  const std::optional<double> number = to_number<double>(text);
  if (!number || !std::isfinite(*number)) wrong_value("--iso", "a number, auto, bone, skin or lung", text);
  return *number;
}

std::vector<std::string> comments(const MeshArguments& arguments, const StopOptions& stop, const MeshOptions& options) {
  return {"isoweave " ISOWEAVE_VERSION,
          fmt::format(
              "iso {} inside {} {} {} quality {}{}", options.iso, arguments.inside, options.closed ? "closed" : "open",
              stop_text(stop, kUsualError), arguments.quality,
              extractor_text(arguments) + smooth_text(options) + component_text(component_rule(arguments.components)))};
}

}  // namespace

std::int64_t parse_slab(std::string_view text, std::int64_t slices) {
  const std::int64_t whole = slices + 2;
  if (text == "auto") return 0;
  if (text == "whole") return whole;
  return std::min(parse_count("--slab", text, "16, auto or whole"), whole);
}

MeshOptions mesh_options(const MeshArguments& arguments) {
  MeshOptions options;
  const bool known = arguments.iso != "auto" && arguments.labels.empty() && !has_several_isos(arguments);
  if (known) options.iso = parse_iso(arguments.iso);
  options.inside_above = parse_choice<bool>("--inside", arguments.inside, {{"above", true}, {"below", false}});
  options.closed = !arguments.open;
  options.smooth = parse_smooth(arguments.smooth);
  options.extractor = parse_extractor(arguments.extractor);
  options.quality = parse_quality(arguments.quality);
  options.normals = parse_normals(arguments.normals);
  options.drop_specks = drops_specks(arguments.stop);
  options.space = parse_space(arguments.space);
  return options;
}

void set_automatic_normals(const MeshArguments& arguments, MeshOptions& options) {
  const bool automatic = arguments.normals == "auto" && !arguments.preview.given();
  if (automatic && output_format(arguments.output) == MeshFormat::kGlb) options.normals = Normals::kGradient;
}

void set_lengths(const MeshArguments& arguments, const VolumeInfo& volume, MeshOptions& options) {
  const LengthBasis basis = length_basis(volume);
  options.error = stop_error(arguments.stop, kUsualError, basis);
  if (std::isinf(options.error.value) && arguments.stop.error.empty())
    options.error = Length::units(most_shape_error(volume));
  options.max_distance = stop_distance(arguments.stop, basis);
  options.levels = finer_levels(arguments.stop, basis);
}

void tell_lengths(const MeshArguments& arguments, const VolumeInfo& volume) {
  std::vector<GivenLength> lengths = given_lengths(arguments.stop);
  lengths.push_back(given_cell(arguments.preview));
  const bool stated = arguments.output.given() && states_unit(arguments.output);
  tell_lengths(volume.path, lengths, stated, length_basis(volume));
}

std::unique_ptr<SliceSource> open_values(const MeshArguments& arguments) {
  if (arguments.color_by.empty()) return nullptr;
  InputOptions input;
  set_place(input, arguments.color_by);
  input.roi = arguments.input.roi;
  input.step = arguments.input.step;
  input.even_spacing = arguments.input.even_spacing;
  input.external = arguments.input.external;
  return open_input(input);
}

void refuse_secrets(const MeshArguments& arguments, std::string_view kept) {
  for (const std::string& url : {arguments.input.secret_url, arguments.color_by}) {
    if (!is_url(url) || url.find_first_of("@?") == std::string::npos) continue;
    throw std::invalid_argument(
        fmt::format("{}: expected a URL without a user and a query, which are kept in no {}", shown_url(url), kept));
  }
}

AutomaticIso automatic_iso(const InputOptions& input, const std::atomic<bool>& stop) {
  const Histogram histogram = read_histogram(*open_input(input), &stop);
  const std::optional<double> iso = otsu_threshold(histogram);
  if (!iso) throw BadInput(input.path + ": --iso auto expects at least two different values, found one or none");
  return {*iso, other_surfaces(histogram, input, &stop)};
}

std::string preset_note(std::string_view iso, double min, double max) {
  const HounsfieldPreset* preset = find_preset(iso);
  if (preset == nullptr || is_hounsfield_range(min, max)) return "";
  return fmt::format("--iso {} is {} in Hounsfield units, but the samples go from {} to {}: is it CT?", iso,
                     preset->iso, min, max);
}

std::string normals_name(Normals normals) {
  if (normals == Normals::kAbsent) return "none";
  return normals == Normals::kGradient ? "gradient" : "quadric";
}

std::string extractor_text(const MeshArguments& arguments) {
  return arguments.extractor == "cubes" ? "" : " extractor " + arguments.extractor;
}

std::string smooth_text(const MeshOptions& options) {
  return options.smooth > 0 ? fmt::format(" smooth {}", options.smooth) : "";
}

MeshFileOptions file_options(const MeshArguments& arguments, const StopOptions& stop, const MeshOptions& options,
                             const VolumeInfo& volume) {
  MeshFileOptions file;
  file.normals = options.normals != Normals::kAbsent;
  file.values = !arguments.color_by.empty();
  file.comments = comments(arguments, stop, options);
  file.unit = volume.geometry.unit;
  file.space = space_of_mesh(volume.geometry, options.space);
  file.offset = mesh_offset(volume, options.space);
  return mesh_file_options(arguments.output, std::move(file));
}

}  // namespace isoweave::cli
