#include "volume/formats/vtk/vtk_arrays.hpp"

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "isoweave/printable.hpp"

namespace isoweave {
namespace {

// "v (3 components), a"
std::string text_of(const VtkArrayNames& names) {
  std::string text;
  for (const VtkArrayName& array : names.all) {
    text += (text.empty() ? "" : ", ") + printable(array.name);
    if (array.components != 1) text += " (" + std::to_string(array.components) + " components)";
  }
  return text;
}

std::string text_of(const VtkArrayNames& points, const VtkArrayNames& cells) {
  if (points.all.empty() && cells.all.empty()) return "no array";
  if (cells.all.empty()) return text_of(points);
  return (points.all.empty() ? "" : text_of(points) + ", ") + "in cells: " + text_of(cells);
}

std::optional<std::size_t> chosen(const VtkArrayNames& names, std::string_view wanted) {
  for (std::size_t n = 0; n < names.all.size(); ++n) {
    if (would_choose(names, names.all[n], wanted)) return n;
  }
  return std::nullopt;
}

}  // namespace

bool would_choose(const VtkArrayNames& names, const VtkArrayName& array, std::string_view wanted) {
  if (!wanted.empty()) return array.name == wanted;
  if (!names.active.empty()) return array.name == names.active;
  // "vtkGhostType" and the like say which points and cells are doubled, or were something else once.
  return array.components == 1 && !array.name.starts_with("vtk");
}

VtkChoice choose_vtk_array(const VtkArrayNames& points, const VtkArrayNames& cells, std::string_view wanted,
                           const std::string& path) {
  for (const bool in_cells : {false, true}) {
    const VtkArrayNames& names = in_cells ? cells : points;
    const std::optional<std::size_t> found = chosen(names, wanted);
    if (found && names.all[*found].components == 1) return {in_cells, *found};
    if (found)
      bad_input(path, "one component per sample in " + in_quotes(names.all[*found].name), text_of(points, cells));
    if (wanted.empty() && !names.active.empty()) {
      bad_input(path, "the active array " + in_quotes(names.active), text_of(points, cells));
    }
  }
  bad_input(path, wanted.empty() ? "an array of one component" : "the array " + in_quotes(wanted),
            text_of(points, cells));
}

void note_vtk_choice(VolumeInfo& info, const VtkArrayNames& points, const VtkArrayNames& cells,
                     const VtkChoice& choice) {
  VtkArrayNames others = points;
  VtkArrayNames other_cells = cells;
  VtkArrayNames& names = choice.cells ? other_cells : others;
  const std::string name = printable(names.all[choice.array].name);
  names.all.erase(names.all.begin() + static_cast<std::ptrdiff_t>(choice.array));
  if (choice.cells) info.notes.emplace_back("the array " + name + " is one of cells: samples lie in their middles");
  if (others.all.empty() && other_cells.all.empty()) return;
  info.part = "array " + name;
  info.notes.emplace_back("the array " + name + " is read, not " + text_of(others, other_cells));
}

}  // namespace isoweave
