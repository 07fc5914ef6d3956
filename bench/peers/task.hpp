// What is compared: contestants that do the same task, each behind the same three calls.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input.hpp"
#include "isoweave/mesh.hpp"

namespace bench {

// One run. Constructing it converts the input into the library's own structures, and mesh() converts back: neither is
// timed, so nobody pays for another's data layout.
class Task {
 public:
  virtual ~Task() = default;
  virtual void run() = 0;  // the timed section
  virtual std::size_t triangles() const = 0;
  virtual isoweave::TriangleMesh mesh() const = 0;
};

struct Goal {
  std::size_t triangles = 0;  // to be left
  double length = 0;          // what to use instead, in the mesh's unit, by those that do not take a count
  int threads = 1;
};

// Range, in mean voxels, of the length by which a contestant is steered when it does not take a triangle count.
struct Steering {
  double low = 0, high = 0;
};

template <class Input>
struct Contestant {
  std::string name;
  bool parallel = false;  // serial ones run once per round, whatever the number of threads of the others
  std::function<std::unique_ptr<Task>(const Input&, const Goal&)> start;
  std::optional<Steering> steering = std::nullopt;
};

using Extractor = Contestant<HeldVolume>;
using Simplifier = Contestant<isoweave::TriangleMesh>;
using WholeJob = Contestant<VolumeFile>;

// The first of each list is the one that the others are compared with.
struct Contestants {
  std::vector<Extractor> extractors;
  std::vector<Simplifier> simplifiers;
  std::vector<WholeJob> jobs;
  std::vector<std::string> absent;  // peers that this build does not have
};

Contestants all_contestants();

// Each adds the contestants of one library.
void add_isoweave(Contestants& contestants);
void add_memory_floor(Contestants& contestants);
void add_meshoptimizer(Contestants& contestants);
void add_meshoptimizer_slabs(Contestants& contestants);
void add_vtk_extraction(Contestants& contestants);
void add_vtk_simplification(Contestants& contestants);
void add_vtk_jobs(Contestants& contestants);
void add_vtk_meshoptimizer_job(Contestants& contestants);
void add_cgal(Contestants& contestants);
void add_openmesh(Contestants& contestants);

}  // namespace bench
