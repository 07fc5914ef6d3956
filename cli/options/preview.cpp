#include "options/preview.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "options/values.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kUsualCell = "auto";

}  // namespace

void add_preview_option(CLI::App& verb, PreviewChoice& preview) {
  // --preview is a flag, as a value that stands apart would be taken for the input.
  verb.add_flag(fmt::format("--preview{{{}}}", kUsualCell), preview.cell,
                "A quick look instead: the vertices in each cell of a grid become one, whatever that does to the "
                "topology; --preview=LENGTH: the side of a cell (default: 2vox, or more in a large input)")
      ->excludes("--error", "--quality", "--specks", "--html", "--page-triangles");
}

GivenLength given_cell(const PreviewChoice& preview) {
  return {"--preview", preview.cell == kUsualCell ? "" : preview.cell};
}

Length preview_cell(const PreviewChoice& preview, const LengthBasis& basis) {
  if (preview.cell == kUsualCell) return {};
  return parse_positive_length("--preview", preview.cell, basis);
}

std::string preview_text(const PreviewChoice& preview) { return "preview, cells " + preview.cell; }

void print_preview(const MeshReport& report, std::string_view unit) {
  const PreviewReport& preview = *report.preview;
  print_note(fmt::format(
      "preview, in cells of {:.4g} {}: its vertices are {:.4g} {} (RMS) from the planes that they stand for",
      preview.cell, unit_text(unit), preview.plane_rms, unit_text(unit)));
  print_note("a preview keeps neither parts and tunnels nor edges with two triangles: it is for a look");
}

}  // namespace isoweave::cli
