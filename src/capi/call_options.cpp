#include "capi/call_options.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "capi/guard.hpp"
#include "isoweave/error.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::capi {
namespace {

Length length(const char* name, const std::string& text, const LengthBasis& basis) {
  try {
    return parse_length(text, basis.unit, basis.diagonal);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(name) + ": " + error.what());
  }
}

std::vector<Length> lengths(const char* name, const std::string& texts, const LengthBasis& basis) {
  std::vector<Length> all;
  std::istringstream list(texts + ",");
  for (std::string text; std::getline(list, text, ',');) all.push_back(length(name, text, basis));
  return all;
}

// One of a list of choices whose numbers begin with 0.
template <class Choice>
Choice choice(const char* name, std::int32_t number, std::initializer_list<Choice> choices) {
  if (number < 0 || static_cast<std::size_t>(number) >= choices.size()) {
    throw std::invalid_argument(std::string(name) + ": expected a number from 0 to " +
                                std::to_string(choices.size() - 1) + ", found " + std::to_string(number));
  }
  return choices.begin()[number];
}

bool has_number(const iw_simplify_options& given) { return given.triangles > 0 || given.ratio != 0; }

// The error up to which a run goes.
Length error_of(const iw_simplify_options& given, const LengthBasis& basis, const std::string& usual) {
  const Length infinite = Length::units(std::numeric_limits<double>::infinity());
  const bool bounded = has_number(given) || given.max_distance != nullptr;
  if (given.error != nullptr) {
    return bounded && std::string_view(given.error) == "inf" ? infinite : length("error", given.error, basis);
  }
  if (has_number(given)) return infinite;
  if (given.max_distance != nullptr) return length("max_distance", given.max_distance, basis);
  if (usual.empty())
    throw std::invalid_argument("expected one of error, levels, max_distance, triangles and ratio, found none");
  return length("error", usual, basis);
}

CheckpointOptions checkpoint_options(const iw_run& given) {
  if (!(given.checkpoint_seconds >= 0) || given.checkpoint_layers < 0)
    throw std::invalid_argument("checkpoint_seconds, checkpoint_layers: expected numbers of at least 0, found " +
                                std::to_string(given.checkpoint_seconds) + " and " +
                                std::to_string(given.checkpoint_layers));
  CheckpointOptions options;
  options.folder = text_of(given.checkpoint);
  options.layers = given.checkpoint_layers;
  if (given.checkpoint_seconds > 0) options.seconds = given.checkpoint_seconds;
  return options;
}

}  // namespace

SimplifyOptions simplify_options(const iw_simplify_options& given, const LengthBasis& basis, const std::string& usual) {
  if (given.levels != nullptr && (given.error != nullptr || has_number(given)))
    throw std::invalid_argument("levels do not go with error, triangles and ratio");
  if (given.triangles > 0 && given.ratio != 0) throw std::invalid_argument("triangles do not go with ratio");
  if (given.ratio != 0 && !(given.ratio > 0 && given.ratio <= 1))
    throw std::invalid_argument("ratio: expected a number above 0 and not above 1, found " +
                                std::to_string(given.ratio));
  SimplifyOptions options;
  if (given.levels != nullptr) {
    options.levels = lengths("levels", given.levels, basis);
    options.error = options.levels.back();
    options.levels.pop_back();
  } else {
    options.error = error_of(given, basis, usual);
  }
  if (given.max_distance != nullptr) options.max_distance = length("max_distance", given.max_distance, basis);
  options.triangles = given.triangles;
  options.share = given.ratio;
  options.quality = choice("quality", given.quality, {Quality::kNormal, Quality::kFast, Quality::kFine});
  options.drop_specks = given.drop_specks != 0;
  return options;
}

ComponentRule component_rule(const iw_simplify_options& given) {
  return {.min_triangles = given.min_component, .largest = given.largest != 0};
}

MeshOptions mesh_options(const iw_mesh_options& given, const iw_simplify_options& simplify, const VolumeInfo& info) {
  MeshOptions options;
  static_cast<SimplifyOptions&>(options) =
      simplify_options(simplify, {info.geometry.unit, box_diagonal(info)}, "0.2vox");
  if (std::isinf(options.error.value) && simplify.error == nullptr)
    options.error = Length::units(most_shape_error(info));
  options.iso = given.iso;
  options.inside_above = given.inside_below == 0;
  options.closed = given.open == 0;
  options.smooth = given.smooth;
  options.extractor =
      choice("extractor", given.extractor,
             {ExtractorKind::kCubes, ExtractorKind::kTrilinear, ExtractorKind::kTetrahedra, ExtractorKind::kDual});
  options.normals = choice("normals", given.normals, {Normals::kAbsent, Normals::kGradient, Normals::kQuadric});
  options.space =
      choice("space", given.space, {OutputSpace::kAsVolume, OutputSpace::kLps, OutputSpace::kRas, OutputSpace::kIndex});
  if (given.values != nullptr) options.values = given.values->opener->open();
  return options;
}

RunControl run_control(const iw_run& given) {
  RunControl control;
  control.threads = given.threads;
  control.device = choice("device", given.device, {Device::kAutomatic, Device::kCpu, Device::kCuda});
  control.slab = given.slab;
  control.memory = given.memory;
  control.checkpoint = checkpoint_options(given);
  if (given.stop != nullptr) control.stop = given.stop->wish;
  if (given.progress == nullptr) return control;
  control.progress = [given](const Progress& progress) {
    const iw_progress told = {sizeof(iw_progress),     progress.layer,           progress.layers, progress.voxels,
                              progress.live_triangles, progress.final_triangles, progress.bytes};
    if (given.progress(given.context, &told) != 0) throw Interrupted("stopped by the caller");
  };
  return control;
}

}  // namespace isoweave::capi
