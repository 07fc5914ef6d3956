#include "options/possible.hpp"

#include <memory>
#include <stdexcept>

namespace isoweave::cli {
namespace {

// The option that asks for a feature.
std::string_view option_of(RunFeature feature, const AskedRun& run) {
  switch (feature) {
    case RunFeature::kDevice:
      return "--device cuda";
    case RunFeature::kTriangles:
      return run.stop.ratio.empty() ? "--triangles" : "--ratio";
    case RunFeature::kLevels:
      return "--lods";
    case RunFeature::kMaxDistance:
      return "--max-distance";
    case RunFeature::kComponents:
      return run.components.largest ? "--largest" : "--min-component";
    case RunFeature::kQuadricNormals:
      return "--normals quadric";
    case RunFeature::kValues:
      return "--color-by";
    case RunFeature::kStates:
      return run.control.resume ? "--resume" : "--checkpoint";
    case RunFeature::kObserver:
      return "--watch";
    case RunFeature::kMemoryCap:
      return "--memory";
    case RunFeature::kExtractor:
      return "an --extractor other than cubes";
    case RunFeature::kDual:
      return "--extractor dual";
    case RunFeature::kIndex:
      return "--index";
    case RunFeature::kSchedule:
      break;
  }
  return "a --schedule other than rounds";
}

}  // namespace

void require_possible(const AskedRun& run) {
  MeshOptions options = run.options;
  if (run.stop.has_number()) options.triangles = 1;
  if (run.stop.has_levels()) options.levels = {Length{}};
  if (!run.stop.max_distance.empty()) options.max_distance = Length::voxels(1);
  if (!component_rule(run.components).keeps_all()) options.components = std::make_shared<ComponentChoice>();
  try {
    isoweave::require_possible(run.kind, options, run.control);
  } catch (const ImpossibleRun& refused) {
    const std::string_view refuser = refused.is_by_device() ? "--device cuda" : run.kind_name;
    throw std::invalid_argument(refused.with_names(refuser, option_of(refused.feature(), run)));
  }
}

}  // namespace isoweave::cli
