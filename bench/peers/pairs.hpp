// Paired measurements: ours and a peer in turn, so that what else the machine does weighs on both.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "child.hpp"
#include "quality.hpp"
#include "task.hpp"

namespace bench {

// A contestant that has its input.
struct Runner {
  std::string name;
  bool parallel = false;
  std::function<std::unique_ptr<Task>(const Goal&)> start;
  std::optional<Steering> steering;
};

// Both must outlive it.
template <class Input>
Runner bind(const Contestant<Input>& contestant, const Input& input) {
  return {contestant.name, contestant.parallel, [&](const Goal& goal) { return contestant.start(input, goal); },
          contestant.steering};
}

struct Settings {
  std::vector<int> threads{1};
  int most_rounds = 9;
  // A pair whose runs have taken this long has no further round. One of which the peer takes about as long as isoweave
  // has five rounds first, unless those take ten times as long as this.
  double enough_seconds = 6;
  double limit_seconds = 900;
  std::string only;  // part of the names of the peers to compare with; empty: all
};

// Finds the length at which a runner leaves the triangles asked for, or as near as it comes: sets the goal's length and
// its triangles to what is left then. The text of a failure, or nothing.
std::string steer(const Runner& runner, double voxel, double limit_seconds, Goal& goal);

struct Entry {
  Runner runner;
  Goal goal;
  Json quality = {};  // measured once: the mesh does not depend on threads and rounds
};

// One row for each number of threads. Quality is measured when `full` is given.
std::vector<Json> compare(Entry& ours, Entry& peer, const Settings& settings, const FullSurface* full);

}  // namespace bench
