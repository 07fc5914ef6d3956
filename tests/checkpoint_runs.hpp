// Runs that tests of saved states compare with.
#pragma once

#include "surfaces.hpp"

namespace isoweave::testing {

inline MeshOptions mesh_options(const SurfaceCase& surface) {
  MeshOptions options;
  options.iso = suggested_iso(surface.volume.kind, surface.volume.type);
  options.closed = surface.closed;
  options.error = Length::voxels(surface.error);
  options.quality = surface.quality;
  return options;
}

inline MeshReport run_whole(const SurfaceCase& surface, const MeshOptions& options) {
  MemorySink sink;
  return mesh_volume(*generate_volume(surface.volume), sink, options);
}

}  // namespace isoweave::testing
