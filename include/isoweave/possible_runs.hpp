// The options that go together in a run, and those that do not.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "isoweave/mesh_options.hpp"
#include "isoweave/run.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// The kinds of runs: the mesh of a volume, the meshes of labels, those of several iso-values, a choice of components, a
// mesh from a mesh, the mesh of a volume in blocks (by one process, tasks or ranks), the preview of a volume or a mesh.
enum class RunKind : std::uint8_t { kMesh, kLabels, kIsoValues, kComponents, kSimplify, kBlocks, kPreview };

// The features that do not go with every kind of run, or not with a device. In parentheses the options that ask for
// them.
enum class RunFeature : std::uint8_t {
  kDevice,          // a CUDA device (RunControl::device)
  kTriangles,       // a number of triangles to stop at (SimplifyOptions::triangles)
  kLevels,          // levels (SimplifyOptions::levels)
  kMaxDistance,     // a guaranteed distance (SimplifyOptions::max_distance)
  kComponents,      // components to be dropped (SurfaceOptions::components)
  kQuadricNormals,  // normals by quadrics (AttributeOptions::normals)
  kValues,          // values of another volume (AttributeOptions::values)
  kStates,          // states to be saved or resumed (RunControl::checkpoint, resume)
  kObserver,        // an observer (RunControl::observer)
  kMemoryCap,       // a cap on memory (RunControl::memory)
  kExtractor,       // an extractor other than marching cubes (SurfaceOptions::extractor)
  kDual,            // dual marching cubes (SurfaceOptions::extractor)
  kSchedule,        // a schedule other than rounds (RunControl::schedule)
  kIndex            // an index of the volume (RunControl::index)
};

// A run that was asked for with a feature which it does not have. what() names both.
class ImpossibleRun : public std::invalid_argument {
 public:
  // by_device: a CUDA device refuses the feature, else the kind of run does. refuser: its name.
  ImpossibleRun(RunFeature feature, bool by_device, const std::string& refuser, const std::string& feature_name,
                const std::string& reason);

  RunFeature feature() const { return feature_; }
  bool is_by_device() const { return by_device_; }

  // The message with names of a program's own, its options say, in place of the library's.
  std::string with_names(std::string_view refuser, std::string_view feature) const;

 private:
  RunFeature feature_;
  bool by_device_;
  std::string reason_;
};

// Checks that the options of a run go together, by one table for all runs. Every run calls it. Checks that need the
// volume are made when the run begins. Of components, values, observers and states it only counts whether there are
// any.
// @throws ImpossibleRun for two options that do not go together
void require_possible(RunKind kind, const MeshOptions& options, const RunControl& control);

}  // namespace isoweave
#pragma GCC visibility pop
