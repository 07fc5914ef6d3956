// Passes over a volume that keep nothing of its surface: the choice of components, and the count of triangles.
#include <memory>
#include <optional>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/volume_sweep.hpp"
#include "select/component_filter.hpp"
#include "select/component_finder.hpp"

namespace isoweave {
namespace {

// The control of a pass that keeps nothing, on the way to the run that is controlled.
RunControl passing_control(const RunControl& control) {
  RunControl passing = control;
  passing.measure = false;
  passing.checkpoint = {};
  passing.resume.reset();
  passing.observer.reset();
  return passing;
}

// The options of a surface with the same connections and as many triangles, that is not smoothed where smoothing
// changes neither: it does where samples decide how a cell is cut.
SurfaceOptions unsmoothed(const SurfaceOptions& options) {
  SurfaceOptions surface = options;
  if (options.extractor != ExtractorKind::kTrilinear) surface.smooth = 0;
  return surface;
}

// One pass over the volume, in which a stage looks at the surface.
class Pass {
 public:
  Pass(SliceSource& volume, const SurfaceOptions& surface, const RunControl& control)
      : control_(passing_control(control)),
        task_(resolve(volume.info(), full_surface(surface), control_, {0, 0, 0}, RunKind::kComponents)),
        identity_(identity_of(task_)),
        sweep_(volume, task_, control_, report_),
        extractor_(sweep_.make_extractor()) {}

  const Task& task() const { return task_; }
  const Executor& executor() const { return sweep_.executor(); }
  VertexNumbering numbering() const { return extractor_->numbering(); }

  // Returns the number of triangles that were extracted.
  std::uint64_t run(PieceStage* stage) {
    sweep_.begin(*extractor_, stage != nullptr ? std::vector{stage} : std::vector<PieceStage*>{}, nullptr);
    sweep_.open();
    while (!sweep_.complete()) {
      check_stop(control_);
      sweep_.step();
    }
    require_unchanged(task_, identity_);
    return report_.triangles_extracted;
  }

 private:
  const RunControl control_;
  const Task task_;
  const RunIdentity identity_;
  MeshReport report_;
  VolumeSweep sweep_;
  std::unique_ptr<Extractor> extractor_;
};

}  // namespace

ComponentChoice choose_components(SliceSource& volume, const SurfaceOptions& options, const ComponentRule& rule,
                                  const RunControl& control) {
  const StandardFloats floats;
  SurfaceOptions all = unsmoothed(options);
  all.components = nullptr;
  Pass pass(volume, all, control);
  ComponentFinder finder(pass.numbering(), pass.executor());
  pass.run(&finder);
  ComponentChoice choice = finder.choose(rule);
  choice.surface = surface_text(pass.task().volume, all);
  return choice;
}

std::uint64_t count_triangles(SliceSource& volume, const SurfaceOptions& options, const RunControl& control) {
  const StandardFloats floats;
  const SurfaceOptions counted = unsmoothed(options);
  Pass pass(volume, counted, control);
  if (counted.components == nullptr) return pass.run(nullptr);
  ComponentFilter filter(*counted.components, pass.numbering(), volume.info().path, pass.executor());
  pass.run(&filter);
  return filter.triangles();
}

}  // namespace isoweave
