// The features that go together in a run and those that do not, in one table.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "isoweave/pipeline.hpp"

namespace isoweave {
namespace {

// The kinds of runs that refuse a feature.
constexpr unsigned kDevice = 1;      // a CUDA device
constexpr unsigned kLabels = 2;      // meshes of labels
constexpr unsigned kComponents = 4;  // the choice of components
constexpr unsigned kSimplify = 8;    // a mesh from a mesh

struct Refuser {
  unsigned bit;
  const char* name;
  const char* reason;
};
constexpr std::array<Refuser, 4> kRefusers{{{kLabels, "labels", "which takes one surface"},
                                            {kComponents, "a choice of components", "which takes processors"},
                                            {kSimplify, "a mesh", "which takes a volume"},
                                            {kDevice, "a CUDA device", "which takes processors"}}};

bool saves(const RunControl& control) { return !control.checkpoint.folder.empty() || control.resume.has_value(); }

struct Feature {
  const char* name;
  unsigned refused_by;
  bool (*asked)(const MeshOptions& options, const RunControl& control);
};
constexpr std::array<Feature, 11> kFeatures{{
    {"a CUDA device", kLabels | kComponents | kSimplify,
     [](const MeshOptions&, const RunControl& control) { return control.device == Device::kCuda; }},
    {"a number of triangles to stop at", kDevice | kLabels,
     [](const MeshOptions& options, const RunControl&) { return options.triangles > 0; }},
    {"levels", kDevice | kLabels,
     [](const MeshOptions& options, const RunControl&) { return !options.levels.empty(); }},
    {"a guaranteed distance", kDevice,
     [](const MeshOptions& options, const RunControl&) { return options.max_distance.value > 0; }},
    {"components to be dropped", kDevice | kLabels,
     [](const MeshOptions& options, const RunControl&) { return options.components != nullptr; }},
    {"normals by quadrics", kDevice,
     [](const MeshOptions& options, const RunControl&) { return options.normals == Normals::kQuadric; }},
    {"values of another volume", kDevice | kLabels,
     [](const MeshOptions& options, const RunControl&) { return options.values != nullptr; }},
    {"states to be saved or resumed", kLabels | kSimplify,
     [](const MeshOptions&, const RunControl& control) { return saves(control); }},
    {"an observer", kDevice | kLabels | kSimplify,
     [](const MeshOptions&, const RunControl& control) { return control.observer != nullptr; }},
    {"a cap on memory", kLabels | kSimplify,
     [](const MeshOptions&, const RunControl& control) { return control.memory > 0; }},
    {"a schedule other than rounds", kDevice,
     [](const MeshOptions&, const RunControl& control) {
       return control.schedule != Schedule::kAutomatic && control.schedule != Schedule::kRounds;
     }},
}};

unsigned refusers_of(RunKind kind, const RunControl& control) {
  const unsigned device = control.device == Device::kCuda ? kDevice : 0;
  if (kind == RunKind::kLabels) return kLabels | device;
  if (kind == RunKind::kComponents) return kComponents | device;
  return (kind == RunKind::kSimplify ? kSimplify : 0) | device;
}

}  // namespace

void require_possible(RunKind kind, const MeshOptions& options, const RunControl& control) {
  const unsigned refusers = refusers_of(kind, control);
  for (const Feature& feature : kFeatures) {
    if (!feature.asked(options, control)) continue;
    for (const Refuser& refuser : kRefusers) {
      if ((refuser.bit & refusers & feature.refused_by) == 0) continue;
      throw std::invalid_argument(std::string(refuser.name) + ": expected a run without " + feature.name + ", " +
                                  refuser.reason);
    }
  }
}

}  // namespace isoweave
