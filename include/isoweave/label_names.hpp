// Names of labels, from files that list them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/label.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// The whole text as a label, or nothing where it is not one: "7112614941", "-3".
std::optional<Label> parse_label(std::string_view text);

// Reads a list of labels and their names; its content tells which kind it is:
//   lines "Index Name R G B A" (FreeSurfer, 3D Slicer), also without the colour
//   lines "Index R G B A Visible Mesh "Name"" (ITK-SNAP)
//   a table in columns between tabs, with "index" and "name" in its first line, "color" (#RRGGBB) if there is one
//   (BIDS)
// Lines that begin with '#' count in none of them. Throws BadInput when the file is missing or another one, and where a
// label has two names.
std::vector<LabelName> read_label_names(const std::string& path);

// A name for the files of each label, in their order: that of `names`, or "label7" where there is none. Letters and
// digits stay, of any script; what a path or a shell could take for something else becomes '_'. Names that are then the
// same, for a file system that takes "A" for "a" as well, have their labels behind them.
std::vector<std::string> label_file_names(std::span<const LabelName> labels);

}  // namespace isoweave
#pragma GCC visibility pop
