#include "options/components.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "options/values.hpp"
#include "report/print.hpp"

namespace isoweave::cli {

void add_component_options(CLI::App& verb, ComponentOptions& components, const std::string& surface) {
  verb.add_option("--min-component", components.min_component,
                  "Drop components with fewer triangles than this in the " + surface);
  verb.add_flag("--largest", components.largest, "Keep only the component with the most triangles in the " + surface);
}

ComponentRule component_rule(const ComponentOptions& components) {
  ComponentRule rule;
  rule.largest = components.largest;
  if (!components.min_component.empty()) {
    rule.min_triangles = static_cast<std::uint64_t>(parse_count("--min-component", components.min_component));
  }
  return rule;
}

std::string component_text(const ComponentRule& rule) {
  return (rule.min_triangles > 1 ? fmt::format(" components of {} triangles or more", rule.min_triangles) : "") +
         (rule.largest ? " largest component" : "");
}

void print_dropped(const MeshReport& report) {
  if (report.components_dropped == 0) return;
  print_note(fmt::format("dropped: {} component{} with {} of the {} triangles", grouped(report.components_dropped),
                         report.components_dropped == 1 ? "" : "s", grouped(report.triangles_dropped),
                         grouped(report.triangles_extracted)));
}

}  // namespace isoweave::cli
