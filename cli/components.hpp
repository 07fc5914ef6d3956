// Which components of a surface are kept.
#pragma once

#include <string>

#include "cli_app.hpp"
#include "isoweave/components.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::cli {

struct ComponentOptions {
  std::string min_component;  // as given; empty: not
  bool largest = false;
};

// `surface`: what the triangles are counted in.
void add_component_options(CLI::App& verb, ComponentOptions& components, const std::string& surface);

ComponentRule component_rule(const ComponentOptions& components);

// " largest component", for the comments of a mesh file; empty where all are kept.
std::string component_text(const ComponentRule& rule);

// A line about what was dropped, if anything was.
void print_dropped(const MeshReport& report);

}  // namespace isoweave::cli
