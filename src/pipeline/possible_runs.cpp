// The features that go together in a run and those that do not, in one table.
#include "isoweave/possible_runs.hpp"

#include <array>

namespace isoweave {
namespace {

// The kinds of runs that refuse a feature.
constexpr unsigned kDevice = 1;      // a CUDA device
constexpr unsigned kLabels = 2;      // meshes of labels
constexpr unsigned kComponents = 4;  // the choice of components
constexpr unsigned kSimplify = 8;    // a mesh from a mesh
constexpr unsigned kIsoValues = 16;  // meshes of several iso-values
constexpr unsigned kBlocks = 32;     // a mesh in blocks
constexpr unsigned kPreview = 64;    // a preview

struct Refuser {
  unsigned bit;
  const char* name;
  const char* reason;
};
constexpr std::array<Refuser, 7> kRefusers{{{kLabels, "labels", "which takes one surface"},
                                            {kBlocks, "blocks", "which takes slabs"},
                                            {kIsoValues, "several iso-values", "which takes one surface"},
                                            {kPreview, "a preview", "which takes the simplifier"},
                                            {kComponents, "a choice of components", "which takes processors"},
                                            {kSimplify, "a mesh", "which takes a volume"},
                                            {kDevice, "a CUDA device", "which takes processors"}}};

bool saves(const RunControl& control) { return !control.checkpoint.folder.empty() || control.resume.has_value(); }

struct Feature {
  RunFeature feature;
  const char* name;
  unsigned refused_by;
  bool (*asked)(const MeshOptions& options, const RunControl& control);
};
constexpr std::array<Feature, 14> kFeatures{{
    {RunFeature::kDevice, "a CUDA device", kLabels | kIsoValues | kComponents | kSimplify | kBlocks | kPreview,
     [](const MeshOptions&, const RunControl& control) { return control.device == Device::kCuda; }},
    {RunFeature::kTriangles, "a number of triangles to stop at", kDevice | kPreview,
     [](const MeshOptions& options, const RunControl&) { return options.triangles > 0 || options.share != 0; }},
    {RunFeature::kLevels, "levels", kDevice | kLabels | kIsoValues | kPreview,
     [](const MeshOptions& options, const RunControl&) { return !options.levels.empty(); }},
    {RunFeature::kMaxDistance, "a guaranteed distance", kDevice | kBlocks | kPreview,
     [](const MeshOptions& options, const RunControl&) { return options.max_distance.value > 0; }},
    {RunFeature::kComponents, "components to be dropped", kDevice | kLabels | kIsoValues | kBlocks | kPreview,
     [](const MeshOptions& options, const RunControl&) { return options.components != nullptr; }},
    {RunFeature::kQuadricNormals, "normals by quadrics", kDevice | kPreview,
     [](const MeshOptions& options, const RunControl&) { return options.normals == Normals::kQuadric; }},
    {RunFeature::kValues, "values of another volume", kDevice | kLabels | kIsoValues | kBlocks | kPreview,
     [](const MeshOptions& options, const RunControl&) { return options.values != nullptr; }},
    {RunFeature::kStates, "states to be saved or resumed", kLabels | kIsoValues | kSimplify | kBlocks | kPreview,
     [](const MeshOptions&, const RunControl& control) { return saves(control); }},
    {RunFeature::kObserver, "an observer", kDevice | kLabels | kIsoValues | kSimplify | kBlocks | kPreview,
     [](const MeshOptions&, const RunControl& control) { return control.observer != nullptr; }},
    {RunFeature::kMemoryCap, "a cap on memory", kLabels | kIsoValues | kSimplify | kPreview,
     [](const MeshOptions&, const RunControl& control) { return control.memory > 0; }},
    {RunFeature::kExtractor, "an extractor other than marching cubes", kDevice | kSimplify,
     [](const MeshOptions& options, const RunControl&) { return options.extractor != ExtractorKind::kCubes; }},
    {RunFeature::kDual, "dual marching cubes", kBlocks,
     [](const MeshOptions& options, const RunControl&) { return options.extractor == ExtractorKind::kDual; }},
    {RunFeature::kSchedule, "a schedule other than rounds", kDevice,
     [](const MeshOptions&, const RunControl& control) {
       return control.schedule != Schedule::kAutomatic && control.schedule != Schedule::kRounds;
     }},
    {RunFeature::kIndex, "an index of the volume", kLabels | kIsoValues | kSimplify | kBlocks,
     [](const MeshOptions&, const RunControl& control) { return control.index != nullptr; }},
}};

unsigned refusers_of(RunKind kind, const RunControl& control) {
  const unsigned device = control.device == Device::kCuda ? kDevice : 0;
  if (kind == RunKind::kLabels) return kLabels | device;
  if (kind == RunKind::kIsoValues) return kIsoValues | device;
  if (kind == RunKind::kBlocks) return kBlocks | device;
  if (kind == RunKind::kComponents) return kComponents | device;
  if (kind == RunKind::kPreview) return kPreview | device;
  return (kind == RunKind::kSimplify ? kSimplify : 0) | device;
}

std::string refusal(std::string_view refuser, std::string_view feature, std::string_view reason) {
  std::string text(refuser);
  text += ": expected a run without ";
  text += feature;
  text += ", ";
  text += reason;
  return text;
}

}  // namespace

ImpossibleRun::ImpossibleRun(RunFeature feature, bool by_device, const std::string& refuser,
                             const std::string& feature_name, const std::string& reason)
    : std::invalid_argument(refusal(refuser, feature_name, reason)),
      feature_(feature),
      by_device_(by_device),
      reason_(reason) {}

std::string ImpossibleRun::with_names(std::string_view refuser, std::string_view feature) const {
  return refusal(refuser, feature, reason_);
}

void require_possible(RunKind kind, const MeshOptions& options, const RunControl& control) {
  const unsigned refusers = refusers_of(kind, control);
  for (const Feature& feature : kFeatures) {
    if (!feature.asked(options, control)) continue;
    for (const Refuser& refuser : kRefusers) {
      if ((refuser.bit & refusers & feature.refused_by) == 0) continue;
      throw ImpossibleRun(feature.feature, refuser.bit == kDevice, refuser.name, feature.name, refuser.reason);
    }
  }
}

}  // namespace isoweave
