#include "verbs/mesh_task_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace isoweave::cli {

void add_surface_options(CLI::App& verb, MeshArguments& arguments) {
  verb.add_option(
      "--iso", arguments.iso,
      "Value of the surface; auto (Otsu's threshold); or bone, skin or lung in CT. Several with commas: a file "
      "each, such as a_iso10.ply for a.ply, or one with --one-file");
  CLI::Option* open = verb.add_flag("--open", arguments.open, "Let the surface end at the volume's border");
  verb.add_flag("--closed", arguments.closed, "Close the surface at the volume's border (default)")->excludes(open);
  verb.add_option("--inside", arguments.inside, "Side of --iso that is inside: above or below")->capture_default_str();
  verb.add_option(
          "--extractor", arguments.extractor,
          "How the surface is made: cubes; trilinear, with tunnels and faces as the samples say; tetrahedra; dual, "
          "which keeps sharp edges")
      ->capture_default_str();
  // --smooth is a flag, as a value that stands apart would be taken for the volume.
  verb.add_flag(fmt::format("--smooth{{{}}}", kUsualSmoothing), arguments.smooth,
                "Smooth the mask of what is inside, each vertex within its edge of the lattice; --smooth=N: passes");
}

void add_simplification_options(CLI::App& verb, MeshArguments& arguments) {
  add_stop_options(verb, arguments.stop);
  verb.get_option("--error")->default_str(kUsualError);
  verb.get_option("--ratio")->description("Stop at this part of the full surface's triangles, such as 10%");
  verb.add_option("--quality", arguments.quality, "fast, normal or fine")->capture_default_str();
  verb.add_option(
          "--normals", arguments.normals,
          "none, gradient, quadric (gradients that simplification takes into account), or auto: gradient in .glb")
      ->capture_default_str();
  verb.add_option("--space", arguments.space, "Coordinates of the output: lps, ras or index (default: the volume's)");
}

}  // namespace isoweave::cli
