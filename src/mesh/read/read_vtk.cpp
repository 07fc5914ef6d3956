// Legacy VTK files with polygons: points, polygons and strips of PolyData, and the flat cells of an unstructured grid.
#include <algorithm>

#include "files/quoted.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/vtk_ghosts.hpp"
#include "mesh/read/vtk_mesh.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/vtk/vtk_legacy_file.hpp"

namespace isoweave::mesh_io {
namespace {

// Cells one after another: the ends of the cells among the corners.
struct Cells {
  std::vector<std::uint64_t> ends, corners;

  std::span<const std::uint64_t> operator[](std::size_t n) const {
    const std::uint64_t begin = n == 0 ? 0 : ends[n - 1];
    return std::span(corners).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(ends[n] - begin));
  }
};

// Polygons or strips, as they stand in one place of a file.
struct Section {
  Cells cells;
  bool are_strips;
};

class VtkReader {
 public:
  explicit VtkReader(MeshInput& input) : input_(input), file_(input.file()), mesh_(input) {}

  TriangleMesh read() {
    for (auto words = file_.next_words(); !words.empty(); words = file_.next_words()) take_line(words);
    if (!has_points_) input_.fail("expected POINTS of PolyData, found none");
    if (grid_ && types_.size() != grid_->ends.size()) input_.fail("expected a type for each cell, found others");
    add_flat_cells();
    for (const LegacyArray& array : file_.points.all) read_point_data(array);
    for (const LegacyArray& array : file_.cells.all) {
      if (!is_list_of_ghosts(array)) mesh_.leftovers.not_kept("cell array '" + array.name + "'");
    }
    return mesh_.finish({});
  }

 private:
  void take_line(const std::vector<std::string>& words) {
    const std::string key = legacy_key(words);
    if (key == "DATASET") {
      check_kind(words.size() < 2 ? "" : legacy_key({words[1]}));
    } else if (key == "POINTS") {
      take_points(words);
    } else if (key == "POLYGONS") {
      sections_.push_back({read_cells(words), false});
      polygons_ += sections_.back().cells.ends.size();
    } else if (key == "TRIANGLE_STRIPS") {
      sections_.push_back({read_cells(words), true});
    } else if (key == "VERTICES" || key == "LINES") {
      const std::uint64_t count = read_cells(words).ends.size();
      no_area_ += count;
      mesh_.leftovers.left_out(count, key == "LINES" ? kLineCells : kPointCells);
    } else if (key == "CELLS") {
      grid_ = read_cells(words);
    } else if (key == "CELL_TYPES") {
      types_ = indices(file_.array_here(words[0], "int", 1, file_.count_of(words, 1)));
    } else if (!file_.take_arrays(words)) {
      input_.fail("expected a part of PolyData, found '" + words[0].substr(0, 40) + "'");
    }
  }

  // Adds the cells that have an area, but for ghosts, which are known only at the end of the file. VTK numbers the
  // cells of PolyData in the order vertices, lines, polygons, strips.
  void add_flat_cells() {
    VtkGhosts ghosts = read_ghosts();
    std::uint64_t polygon = no_area_, strip = no_area_ + polygons_;
    for (const auto& [cells, are_strips] : sections_) {
      std::uint64_t& number = are_strips ? strip : polygon;
      for (std::size_t n = 0; n < cells.ends.size(); ++n) {
        if (ghosts.leave_out(number++)) continue;
        are_strips ? mesh_.add_strip(cells[n]) : mesh_.add_polygon(cells[n]);
      }
    }
    for (std::size_t n = 0; grid_ && n < types_.size(); ++n) {
      if (!ghosts.leave_out(n)) mesh_.add_cell(types_[n], (*grid_)[n]);
    }
    mesh_.leftovers.left_out(ghosts.left_out(), kGhostCells);
  }

  static bool is_list_of_ghosts(const LegacyArray& array) {
    return array.components == 1 && VtkGhosts::are_in(array.name, array.type);
  }

  VtkGhosts read_ghosts() {
    const auto found = std::find_if(file_.cells.all.begin(), file_.cells.all.end(), is_list_of_ghosts);
    if (found == file_.cells.all.end()) return {};
    std::uint64_t cells = no_area_ + types_.size();
    for (const Section& section : sections_) cells += section.cells.ends.size();
    if (found->tuples != cells) {
      input_.fail("expected a number in '" + found->name + "' for each of " + std::to_string(cells) + " cells, found " +
                  std::to_string(found->tuples));
    }
    VtkNumbers numbers = open(*found);
    return {numbers, cells};
  }

  void check_kind(const std::string& kind) const {
    if (kind == "POLYDATA" || kind == "UNSTRUCTURED_GRID") return;
    input_.fail("expected DATASET POLYDATA or UNSTRUCTURED_GRID of a mesh, found '" + kind.substr(0, 40) + "'");
  }

  void take_points(const std::vector<std::string>& words) {
    if (has_points_ || words.size() != 3) input_.fail("expected one 'POINTS count type', found others");
    has_points_ = true;
    const LegacyArray array = file_.array_here(words[0], words[2], 3, file_.count_of(words, 1));
    VtkNumbers numbers = open(array);
    mesh_.add_points(numbers, array.tuples, array.type == "Float32");
    file_.skip(array);
  }

  // Opens the numbers of an array, after a check that the file is long enough to hold them.
  VtkNumbers open(const LegacyArray& array) {
    const std::optional<VtkNumberType> type = vtk_xml_number(array.type);
    const std::uint64_t size = file_.file()->size();
    const std::uint64_t left = size - std::min(array.at, size);
    if (!type) input_.fail("expected numbers in '" + array.name + "', found '" + array.type + "'");
    // A digit and a blank for each number.
    const std::uint64_t least = file_.is_text() ? 2 * array.numbers() : type->bytes * array.numbers();
    if (least > left + 1) {
      input_.fail("truncated: expected " + std::to_string(array.numbers()) + " numbers in '" + array.name +
                  "', found " + std::to_string(left) + " bytes");
    }
    return {std::make_unique<FileStream>(file_.file(), array.at, size), *type, file_.is_text(), true, input_.path()};
  }

  std::vector<std::uint64_t> indices(const LegacyArray& array) {
    VtkNumbers numbers = open(array);
    std::vector<std::uint64_t> all;
    for (std::uint64_t n = 0; n < array.numbers(); ++n) all.push_back(numbers.index());
    file_.skip(array);
    return all;
  }

  // Reads cells. Since version 5 there are offsets and then corners, with one offset more than there are cells. Before
  // that, the number of corners stands in front of the corners of each cell.
  Cells read_cells(const std::vector<std::string>& words) {
    const std::uint64_t cells = file_.count_of(words, 1);
    const std::uint64_t numbers = file_.count_of(words, 2);
    return file_.is_next("OFFSETS") ? read_offsets(cells, numbers)
                                    : split(indices(file_.array_here(words[0], "int", 1, numbers)), cells);
  }

  Cells read_offsets(std::uint64_t offsets, std::uint64_t corners) {
    Cells cells;
    cells.ends = indices(next_array("OFFSETS", offsets));
    if (file_.is_next("CONNECTIVITY")) cells.corners = indices(next_array("CONNECTIVITY", corners));
    if (cells.ends.empty()) return cells;
    cells.ends.erase(cells.ends.begin());
    std::uint64_t last = 0;
    for (const std::uint64_t end : cells.ends) {
      if (end < last || end > cells.corners.size()) input_.fail("expected OFFSETS that ascend, found others");
      last = end;
    }
    return cells;
  }

  LegacyArray next_array(std::string_view key, std::uint64_t count) {
    const std::vector<std::string> words = file_.next_words();
    if (words.size() != 2 || legacy_key(words) != key) {
      const std::string found = words.empty() ? "the end of the file" : in_quotes(words[0]);
      input_.fail("expected a line with " + std::string(key) + " and a type, found " + found);
    }
    return file_.array_here(words[0], words[1], 1, count);
  }

  Cells split(const std::vector<std::uint64_t>& numbers, std::uint64_t count) const {
    Cells cells;
    std::size_t at = 0;
    for (; cells.ends.size() < count && at < numbers.size() && numbers[at] < numbers.size() - at;) {
      const auto corners = static_cast<std::size_t>(numbers[at]);
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at) + 1;
      cells.corners.insert(cells.corners.end(), first, first + static_cast<std::ptrdiff_t>(corners));
      cells.ends.push_back(cells.corners.size());
      at += corners + 1;
    }
    if (cells.ends.size() != count || at != numbers.size()) {
      input_.fail("expected " + std::to_string(count) + " cells in " + std::to_string(numbers.size()) +
                  " numbers, found others");
    }
    return cells;
  }

  void read_point_data(const LegacyArray& array) {
    const bool fits = array.tuples == mesh_.points();
    if (fits && array.is_normals && array.components == 3 && !has_normals_) {
      VtkNumbers numbers = open(array);
      mesh_.add_normals(numbers);
      has_normals_ = true;
    } else if (fits && array.is_scalars && array.components == 1 && !array.is_colours && !has_values_) {
      VtkNumbers numbers = open(array);
      mesh_.add_values(numbers);
      has_values_ = true;
    } else {
      mesh_.leftovers.not_kept("point array '" + array.name + "'");
    }
  }

  MeshInput& input_;
  LegacyFile file_;
  VtkMesh mesh_;
  bool has_points_ = false, has_normals_ = false, has_values_ = false;
  std::vector<Section> sections_;
  std::uint64_t no_area_ = 0, polygons_ = 0;  // cells of PolyData
  std::optional<Cells> grid_;
  std::vector<std::uint64_t> types_;
};

}  // namespace

TriangleMesh read_vtk(MeshInput& input) { return VtkReader(input).read(); }

}  // namespace isoweave::mesh_io
