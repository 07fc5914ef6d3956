// The options of isoweave mesh that say which mesh is made, as isoweave plan has them as well.
#pragma once

#include "options/cli_app.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// Which surface.
void add_surface_options(CLI::App& verb, MeshArguments& arguments);

// How it is simplified, its normals and its coordinates.
void add_simplification_options(CLI::App& verb, MeshArguments& arguments);

}  // namespace isoweave::cli
