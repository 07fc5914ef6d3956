// VTP and VTU, VTK's XML polygons and unstructured grids, and PVTP and PVTU, which name files for their pieces: tags up
// to the appended arrays, then the arrays of each piece in every encoding.
#include <algorithm>
#include <map>

#include "files/xml_tag.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/vtk_ghosts.hpp"
#include "mesh/read/vtk_mesh.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/vtk/vtk_xml.hpp"

namespace isoweave::mesh_io {
namespace {

using Arrays = std::vector<VtkArray>;

const VtkArray* find(const Arrays& arrays, std::string_view name) {
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const VtkArray& a) { return a.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

struct VtpPiece {
  std::uint64_t points = 0, verts = 0, lines = 0, strips = 0, polys = 0;
  std::uint64_t cells = 0;               // of an unstructured grid
  std::string source;                    // the file that holds it
  std::string normals, scalars;          // names of the active arrays
  std::map<std::string, Arrays> arrays;  // by the section that they stand in: "Points", "Polys", ...
};

// One file, whose pieces go into a mesh.
class VtpReader {
 public:
  // `kind`: the one type of VTK XML that it may be of; empty: any that is a mesh.
  VtpReader(const MeshInput& input, std::string kind, VtkMesh& mesh, MeshPlace& place)
      : input_(input), kind_(std::move(kind)), file_(input.file()), tags_(file_), place_(place), mesh_(mesh) {}

  void read() {
    check_end();
    for (std::string tag = tags_.next(); !tag.empty() && take_tag(tag); tag = tags_.next()) {
    }
    if (pieces_.empty()) input_.fail("expected a piece of " + form_.type + ", found none");
    for (const VtkArray& text : field_texts_) place_.take(text.name, text_of(text));
    for (const VtpPiece& piece : pieces_) is_list() ? read_named(piece) : read_piece(piece);
  }

 private:
  void check_end() {
    constexpr std::uint64_t kTail = 64;
    std::string tail(static_cast<std::size_t>(std::min(file_->size(), kTail)), '\0');
    file_->read_at(file_->size() - tail.size(), std::as_writable_bytes(std::span(tail)));
    if (tail.find("</VTKFile>") == std::string::npos)
      input_.fail("truncated: expected '</VTKFile>' at the end, found none");
  }

  // False when nothing but appended arrays follows.
  bool take_tag(std::string_view tag) {
    constexpr std::array<std::string_view, 9> kSections{"FieldData", "PointData", "CellData", "Points", "Verts",
                                                        "Lines",     "Strips",    "Polys",    "Cells"};
    const std::string_view name = vtk_tag_name(tag);
    if (name == "VTKFile") take_form(tag);
    if (name == "Piece") take_piece(tag);
    if (std::find(kSections.begin(), kSections.end(), name) != kSections.end()) section_ = name;
    if (name.starts_with('/') && name.substr(1) == section_) section_.clear();
    if (name == "PointData" && !pieces_.empty()) take_active(tag);
    if (name == "Array" && section_ == "FieldData") {
      field_texts_.push_back(vtk_array(tag, tags_.position(), input_.path()));
    }
    if (name == "DataArray" && section_ != "FieldData" && !pieces_.empty()) take_array(tag);
    if (name != "AppendedData") return true;
    appended_ = vtk_appended(tag, tags_.position(), *file_);
    return false;
  }

  void take_form(std::string_view tag) {
    form_ = vtk_xml_form(tag, input_.path());
    static constexpr std::array<std::string_view, 4> kMeshes{"PolyData", "UnstructuredGrid", "PPolyData",
                                                             "PUnstructuredGrid"};
    const bool is_mesh = std::find(kMeshes.begin(), kMeshes.end(), form_.type) != kMeshes.end();
    if (kind_.empty() ? is_mesh : form_.type == kind_) return;
    const std::string expected = kind_.empty() ? "PolyData or UnstructuredGrid" : kind_;
    input_.fail("expected VTK XML of type " + expected + ", found '" + form_.type + "'");
  }

  // A file of pieces in other files.
  bool is_list() const { return form_.type.starts_with("PP") || form_.type.starts_with("PU"); }

  void take_piece(std::string_view tag) {
    constexpr std::size_t kMostPieces = 4096;
    if (pieces_.size() == kMostPieces) input_.fail("expected at most 4096 pieces, found more");
    VtpPiece piece;
    piece.source = xml_attribute(tag, "Source");
    piece.cells = count_of(tag, "NumberOfCells");
    piece.points = count_of(tag, "NumberOfPoints");
    piece.verts = count_of(tag, "NumberOfVerts");
    piece.lines = count_of(tag, "NumberOfLines");
    piece.strips = count_of(tag, "NumberOfStrips");
    piece.polys = count_of(tag, "NumberOfPolys");
    pieces_.push_back(std::move(piece));
  }

  std::uint64_t count_of(std::string_view tag, const char* name) const {
    const std::string text = xml_attribute(tag, name);
    if (text.empty()) return 0;
    const std::optional<std::uint64_t> count = parse_integer<std::uint64_t>(text);
    if (!count || *count > std::uint64_t{1} << 48) {
      input_.fail(std::string("expected a number as ") + name + ", found '" + text.substr(0, 40) + "'");
    }
    return *count;
  }

  void take_active(std::string_view tag) {
    pieces_.back().normals = xml_attribute(tag, "Normals");
    pieces_.back().scalars = xml_attribute(tag, "Scalars");
  }

  // Takes an array. A file with several times has a tag for each of them; the first one counts.
  void take_array(std::string_view tag) {
    Arrays& arrays = pieces_.back().arrays[section_];
    const VtkArray array = vtk_array(tag, tags_.position(), input_.path());
    if (find(arrays, array.name) == nullptr) arrays.push_back(array);
  }

  // A string of the field data. In text encoding it is a list of character numbers; it ends with a 0.
  std::string text_of(const VtkArray& array) {
    constexpr std::uint64_t kLongest = 1024;
    if (array.is_text()) {
      TextStream words(std::make_unique<FileStream>(file_, array.at, file_->size()));
      std::string text;
      for (std::string word = words.next_word(); text.size() < kLongest; word = words.next_word()) {
        const std::optional<std::uint8_t> c = parse_integer<std::uint8_t>(word);
        if (!c || *c == 0) break;
        text.push_back(static_cast<char>(*c));
      }
      return text;
    }
    std::string text(static_cast<std::size_t>(std::min(vtk_array_bytes(file_, form_, array, appended_), kLongest)), 0);
    if (text.empty() || text.size() == kLongest) return {};
    const auto stream = open_vtk_array(file_, form_, array, appended_, text.size());
    text.resize(stream->read(std::as_writable_bytes(std::span(text))));
    return text.substr(0, text.find('\0'));
  }

  // Opens `count` numbers, after a check that the file is long enough to hold them.
  VtkNumbers open(const VtkArray& array, std::uint64_t count) {
    const std::optional<VtkNumberType> type = vtk_xml_number(array.type);
    if (!type) input_.fail("expected an array of numbers, found '" + array.name + "' of type '" + array.type + "'");
    if (!array.is_text()) {
      return {open_vtk_array(file_, form_, array, appended_, count * type->bytes), *type, false, form_.big_endian,
              input_.path()};
    }
    // A digit and a blank for each number.
    check_plausible(input_.path(), 2 * count, file_->size() - array.at + 1, 1);
    return {std::make_unique<FileStream>(file_, array.at, file_->size()), *type, true, false, input_.path()};
  }

  static const Arrays& arrays_of(const VtpPiece& piece, const char* section) {
    static const Arrays kNone;
    const auto found = piece.arrays.find(section);
    return found == piece.arrays.end() ? kNone : found->second;
  }

  void read_named(const VtpPiece& piece) {
    if (piece.source.empty()) input_.fail("expected a file as Source of each piece, found none");
    const MeshInput input(input_.named_file(piece.source));
    VtpReader(input, form_.type.substr(1), mesh_, place_).read();
  }

  void read_piece(const VtpPiece& piece) {
    if (piece.points == 0 && piece.polys == 0 && piece.strips == 0 && piece.cells == 0) return;
    const Arrays& points = arrays_of(piece, "Points");
    if (points.empty() || points.front().components != 3) input_.fail("expected Points of 3 components, found none");
    VtkNumbers numbers = open(points.front(), 3 * piece.points);
    mesh_.add_points(numbers, piece.points, points.front().type == "Float32");
    read_flat_cells(piece);
    mesh_.leftovers.left_out(piece.verts, kPointCells);
    mesh_.leftovers.left_out(piece.lines, kLineCells);
    for (const VtkArray& array : arrays_of(piece, "PointData")) read_point_data(piece, array);
    for (const VtkArray& array : arrays_of(piece, "CellData")) {
      if (!is_list_of_ghosts(array)) mesh_.leftovers.not_kept("cell array '" + array.name + "'");
    }
  }

  // Adds the cells that have an area, but for ghosts. VTK numbers the cells of PolyData in the order vertices, lines,
  // polygons, strips.
  void read_flat_cells(const VtpPiece& piece) {
    using Corners = std::span<const std::uint64_t>;
    VtkGhosts ghosts = ghosts_of(piece);
    const std::uint64_t polys = piece.verts + piece.lines, strips = polys + piece.polys;
    read_cells(piece, "Polys", piece.polys, [&](std::size_t n, Corners corners) {
      if (!ghosts.leave_out(polys + n)) mesh_.add_polygon(corners);
    });
    read_cells(piece, "Strips", piece.strips, [&](std::size_t n, Corners corners) {
      if (!ghosts.leave_out(strips + n)) mesh_.add_strip(corners);
    });
    const std::vector<std::uint64_t> kinds = kinds_of(piece);
    read_cells(piece, "Cells", piece.cells, [&](std::size_t n, Corners corners) {
      if (!ghosts.leave_out(n)) mesh_.add_cell(kinds[n], corners);
    });
    mesh_.leftovers.left_out(ghosts.left_out(), kGhostCells);
  }

  static bool is_list_of_ghosts(const VtkArray& array) {
    return array.components == 1 && VtkGhosts::are_in(array.name, array.type);
  }

  VtkGhosts ghosts_of(const VtpPiece& piece) {
    const Arrays& arrays = arrays_of(piece, "CellData");
    const auto found = std::find_if(arrays.begin(), arrays.end(), is_list_of_ghosts);
    if (found == arrays.end()) return {};
    const std::uint64_t cells = piece.verts + piece.lines + piece.polys + piece.strips + piece.cells;
    VtkNumbers numbers = open(*found, cells);
    return {numbers, cells};
  }

  // The kinds of the cells of an unstructured grid.
  std::vector<std::uint64_t> kinds_of(const VtpPiece& piece) {
    if (piece.cells == 0) return {};
    const VtkArray* const types = find(arrays_of(piece, "Cells"), "types");
    if (types == nullptr) input_.fail("expected types of Cells, found none");
    VtkNumbers numbers = open(*types, piece.cells);
    std::vector<std::uint64_t> kinds;
    for (std::uint64_t n = 0; n < piece.cells; ++n) kinds.push_back(numbers.index());
    return kinds;
  }

  // Reads the ends of the cells among the corners, then the corners. add(n, corners) takes each cell.
  template <class Add>
  void read_cells(const VtpPiece& piece, const char* section, std::uint64_t count, const Add& add) {
    if (count == 0) return;
    const VtkArray* const offsets = find(arrays_of(piece, section), "offsets");
    const VtkArray* const connectivity = find(arrays_of(piece, section), "connectivity");
    if (offsets == nullptr || connectivity == nullptr) {
      input_.fail(std::string("expected connectivity and offsets in ") + section + ", found none");
    }
    VtkNumbers numbers = open(*offsets, count);
    std::vector<std::uint64_t> ends;
    for (std::uint64_t n = 0; n < count; ++n) {
      const std::uint64_t end = numbers.index();
      if ((n > 0 && end < ends.back()) || end > std::uint64_t{1} << 48) {
        input_.fail(std::string("expected offsets that ascend in ") + section + ", found others");
      }
      ends.push_back(end);
    }
    if (ends.back() == 0) return mesh_.leftovers.left_out(count, kFewCorners);
    VtkNumbers corners = open(*connectivity, ends.back());
    std::vector<std::uint64_t> cell;
    std::uint64_t begin = 0;
    for (std::size_t n = 0; n < ends.size(); ++n) {
      cell.clear();
      for (; begin < ends[n]; ++begin) cell.push_back(corners.index());
      add(n, cell);
    }
  }

  void read_point_data(const VtpPiece& piece, const VtkArray& array) {
    if (array.name == piece.normals && array.components == 3) {
      VtkNumbers numbers = open(array, 3 * piece.points);
      mesh_.add_normals(numbers);
    } else if (array.name == piece.scalars && array.components == 1 && vtk_xml_number(array.type)) {
      VtkNumbers numbers = open(array, piece.points);
      mesh_.add_values(numbers);
    } else {
      mesh_.leftovers.not_kept("point array '" + array.name + "'");
    }
  }

  const MeshInput& input_;
  std::string kind_;
  FilePtr file_;
  VtkTags tags_;
  VtkXmlForm form_;
  VtkAppended appended_;
  std::string section_;
  std::vector<VtkArray> field_texts_;
  std::vector<VtpPiece> pieces_;
  MeshPlace& place_;
  VtkMesh& mesh_;
};

}  // namespace

TriangleMesh read_vtp(MeshInput& input) {
  VtkMesh mesh(input);
  MeshPlace place;
  VtpReader(input, "", mesh, place).read();
  return mesh.finish(place);
}

}  // namespace isoweave::mesh_io
