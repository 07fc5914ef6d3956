// Turns the command line of isoweave mesh into the options of the library.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"
#include "options/input_volume.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// Layers per slab; 0: chosen by the run. A whole volume is one layer thicker than its slices when it is closed.
std::int64_t parse_slab(std::string_view text, std::int64_t slices);

// The options that need no volume.
MeshOptions mesh_options(const MeshArguments& arguments);

// Chooses normals for --normals auto: viewers of GLB draw a surface without them in facets. Previews have none.
void set_automatic_normals(const MeshArguments& arguments, MeshOptions& options);

// Sets the lengths among the options, which may be in the unit of the volume.
void set_lengths(const MeshArguments& arguments, const VolumeInfo& volume, MeshOptions& options);

// Says what is to be said of the unit of the volume and of the lengths that were given. When the run is done: a run
// that fails has one line.
void tell_lengths(const MeshArguments& arguments, const VolumeInfo& volume);

// The volume whose values the vertices get, opened with the choices made for the first volume; or null.
std::unique_ptr<SliceSource> open_values(const MeshArguments& arguments);

// Throws std::invalid_argument for a URL with a user or a query, which must not get into `kept`, a file.
void refuse_secrets(const MeshArguments& arguments, std::string_view kept);

// Otsu's threshold, and a line about other surfaces that the volume has.
struct AutomaticIso {
  double iso = 0;
  std::string others;  // empty: none
};

// Reads the volume once more, by itself, as slices cannot be read twice.
AutomaticIso automatic_iso(const InputOptions& input, const std::atomic<bool>& stop);

// A warning where --iso names a tissue and the range of the samples is not that of CT; else empty.
std::string preset_note(std::string_view iso, double min, double max);

// The name of a kind of normals on the command line.
std::string normals_name(Normals normals);

// " extractor dual", for the comments of a mesh file; empty for the usual one.
std::string extractor_text(const MeshArguments& arguments);

// " smooth 4", for the comments of a mesh file; empty where nothing is smoothed.
std::string smooth_text(const MeshOptions& options);

// The options of a level's mesh file.
MeshFileOptions file_options(const MeshArguments& arguments, const StopOptions& stop, const MeshOptions& options,
                             const VolumeInfo& volume);

}  // namespace isoweave::cli
