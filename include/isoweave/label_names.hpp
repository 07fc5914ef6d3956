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

// The whole text as a label: "7112614941", "-3". Nothing where it is not a whole number of 64 bits.
std::optional<Label> parse_label(std::string_view text);

// Reads a list of labels and their names, in the order of the file. Its content tells which kind it is:
//   lines "Index Name R G B A" (FreeSurfer, 3D Slicer), also without the colour
//   lines "Index R G B A Visible Mesh "Name"" (ITK-SNAP)
//   a table in columns between tabs, with "index" and "name" in its first line, "color" (#RRGGBB) if there is one
//   (BIDS)
// In all kinds, empty lines and lines that begin with '#' are skipped.
// @throws BadInput when the file is missing, larger than 64 MB, of another kind or without names, and where a label has
//   two names
std::vector<LabelName> read_label_names(const std::string& path);

// A name for the files of each label, in the order of `labels`: its own name, or "label7" where it has none. Letters
// and digits of any script stay; other characters that mean something to a path or a shell become '_'. Names that are
// then equal, also but for capitals, get their label appended.
std::vector<std::string> label_file_names(std::span<const LabelName> labels);

}  // namespace isoweave
#pragma GCC visibility pop
