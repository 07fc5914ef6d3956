// The option --preview of mesh and simplify: a look at a surface by vertex clustering.
#pragma once

#include <string>
#include <string_view>

#include "isoweave/preview.hpp"
#include "options/cli_app.hpp"
#include "options/lengths.hpp"

namespace isoweave::cli {

struct PreviewChoice {
  std::string cell;  // as given; "auto": the usual size; empty: no preview

  bool given() const { return !cell.empty(); }
};

// Adds --preview. Must be called after --error, --quality and --specks, with which it does not go. The library refuses
// the rest: see require_possible.
void add_preview_option(CLI::App& verb, PreviewChoice& preview);

// The side of a cell as it was given; without a text for the usual one.
GivenLength given_cell(const PreviewChoice& preview);

// The side of a cell; 0: the usual one.
Length preview_cell(const PreviewChoice& preview, const LengthBasis& basis);

// "preview, cells auto", for the comments of a mesh file.
std::string preview_text(const PreviewChoice& preview);

// Says how large the cells of a preview are, how good it is, and that it is no more than a look.
void print_preview(const MeshReport& report, std::string_view unit);

}  // namespace isoweave::cli
