// The options that go together in a run of mesh or simplify: the table of possible_runs.hpp, with their names here.
#pragma once

#include <string_view>

#include "isoweave/possible_runs.hpp"
#include "options/components.hpp"
#include "options/stop.hpp"

namespace isoweave::cli {

// A run as it was asked for, before any file is looked at.
struct AskedRun {
  RunKind kind;
  std::string_view kind_name;  // the option or verb that asks for this kind
  const MeshOptions& options;
  const RunControl& control;
  const StopOptions& stop;
  const ComponentOptions& components;
};

// require_possible() for a run whose numbers and lengths are not known yet, as they depend on the input: it counts that
// they were asked for. Throws std::invalid_argument that names both options.
void require_possible(const AskedRun& run);

}  // namespace isoweave::cli
