// The command line of isoweave mesh.
#pragma once

#include <string>

#include "options/components.hpp"
#include "options/index.hpp"
#include "options/input_volume.hpp"
#include "options/output_mesh.hpp"
#include "options/preview.hpp"
#include "options/run.hpp"
#include "options/stop.hpp"
#include "page/page.hpp"
#include "watch/watch.hpp"

namespace isoweave::cli {

inline constexpr const char* kUsualError = "0.2vox";

struct MeshArguments {
  InputOptions input;
  RunOptions run;
  OutputOptions output;
  StopOptions stop;
  PreviewChoice preview;
  ComponentOptions components;
  PageOptions page;
  WatchOptions watch;
  IndexOptions index;
  std::string iso, quality = "normal", slab, inside = "above", normals = "auto", extractor = "cubes";
  std::string color_by, space, memory, blocks, checkpoint, every, resume, labels, label_names, min_label, smooth;
  bool open = false, closed = false, dry_run = false, numbered = false;
};

}  // namespace isoweave::cli
