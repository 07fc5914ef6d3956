// The command line of isoweave mesh.
#pragma once

#include <string>

#include "components.hpp"
#include "mesh_output.hpp"
#include "options.hpp"
#include "page.hpp"
#include "stop.hpp"
#include "watch.hpp"

namespace isoweave::cli {

inline constexpr const char* kUsualError = "0.2vox";

struct MeshArguments {
  InputOptions input;
  RunOptions run;
  OutputOptions output;
  StopOptions stop;
  ComponentOptions components;
  PageOptions page;
  WatchOptions watch;
  std::string iso, quality = "normal", slab, inside = "above", normals = "none";
  std::string color_by, space, memory, checkpoint, every, resume, labels, label_names, smooth;
  bool open = false, closed = false, dry_run = false, numbered = false;
};

}  // namespace isoweave::cli
