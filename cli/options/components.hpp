// The options of mesh and simplify that choose which components of a surface are kept.
#pragma once

#include <string>

#include "isoweave/components.hpp"
#include "isoweave/pipeline.hpp"
#include "options/cli_app.hpp"

namespace isoweave::cli {

struct ComponentOptions {
  std::string min_component;  // as given; empty: not
  bool largest = false;
};

// `surface`: the surface whose triangles are counted, for the help text.
void add_component_options(CLI::App& verb, ComponentOptions& components, const std::string& surface);

ComponentRule component_rule(const ComponentOptions& components);

// " largest component", for the comments of a mesh file; empty where all are kept.
std::string component_text(const ComponentRule& rule);

// Prints a line about the dropped components, if any.
void print_dropped(const MeshReport& report);

}  // namespace isoweave::cli
