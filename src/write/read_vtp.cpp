// VTP, VTK's XML polygons: tags up to the appended arrays, then the arrays of each piece in every encoding.
#include <algorithm>
#include <map>

#include "volume/formats.hpp"
#include "volume/vtk_xml.hpp"
#include "volume/xml_tag.hpp"
#include "write/mesh_input.hpp"
#include "write/vtk_mesh.hpp"

namespace isoweave::mesh_io {
namespace {

using Arrays = std::vector<VtkArray>;

const VtkArray* find(const Arrays& arrays, std::string_view name) {
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const VtkArray& a) { return a.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

struct VtpPiece {
  std::uint64_t points = 0, verts = 0, lines = 0, strips = 0, polys = 0;
  std::string normals, scalars;          // names of the active arrays
  std::map<std::string, Arrays> arrays;  // by the section that they stand in: "Points", "Polys", ...
};

class VtpReader {
 public:
  explicit VtpReader(MeshInput& input) : input_(input), file_(input.file()), tags_(file_), mesh_(input) {}

  TriangleMesh read() {
    check_end();
    for (std::string tag = tags_.next(); !tag.empty() && take_tag(tag); tag = tags_.next()) {
    }
    if (pieces_.empty()) input_.fail("expected a piece of PolyData, found none");
    for (const VtkArray& text : field_texts_) place_.take(text.name, text_of(text));
    for (const VtpPiece& piece : pieces_) read_piece(piece);
    return mesh_.finish(place_);
  }

 private:
  void check_end() {
    constexpr std::uint64_t kTail = 64;
    input_.move_to(input_.size() - std::min(input_.size(), kTail));
    std::string tail(static_cast<std::size_t>(input_.remaining()), '\0');
    input_.read(std::as_writable_bytes(std::span(tail)));
    if (tail.find("</VTKFile>") == std::string::npos) input_.fail("truncated: expected '</VTKFile>' at the end");
  }

  // False when nothing but appended arrays follows.
  bool take_tag(std::string_view tag) {
    constexpr std::array<std::string_view, 8> kSections{"FieldData", "PointData", "CellData", "Points",
                                                        "Verts",     "Lines",     "Strips",   "Polys"};
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
    if (form_.type != "PolyData") input_.fail("expected VTK XML of type PolyData, found '" + form_.type + "'");
  }

  void take_piece(std::string_view tag) {
    VtpPiece piece;
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

  // With several times an array has a tag for each; the first one counts.
  void take_array(std::string_view tag) {
    Arrays& arrays = pieces_.back().arrays[section_];
    const VtkArray array = vtk_array(tag, tags_.position(), input_.path());
    if (find(arrays, array.name) == nullptr) arrays.push_back(array);
  }

  // A string of the field data. As text it is the numbers of its characters; it ends with a 0.
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

  // `count` numbers, which the file is compared with before anybody makes room for them.
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

  void read_piece(const VtpPiece& piece) {
    if (piece.points == 0 && piece.polys == 0 && piece.strips == 0) return;
    const Arrays& points = arrays_of(piece, "Points");
    if (points.empty() || points.front().components != 3) input_.fail("expected Points of 3 components, found none");
    VtkNumbers numbers = open(points.front(), 3 * piece.points);
    mesh_.add_points(numbers, piece.points, points.front().type == "Float32");
    read_cells(piece, "Polys", piece.polys, &VtkMesh::add_polygon);
    read_cells(piece, "Strips", piece.strips, &VtkMesh::add_strip);
    mesh_.leftovers.left_out(piece.verts, kPointCells);
    mesh_.leftovers.left_out(piece.lines, kLineCells);
    for (const VtkArray& array : arrays_of(piece, "PointData")) read_point_data(piece, array);
    for (const VtkArray& array : arrays_of(piece, "CellData"))
      mesh_.leftovers.not_kept("cell array '" + array.name + "'");
  }

  // Where each cell ends among the corners, then the corners.
  void read_cells(const VtpPiece& piece, const char* section, std::uint64_t count,
                  void (VtkMesh::*add)(std::span<const std::uint64_t>)) {
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
    for (const std::uint64_t end : ends) {
      cell.clear();
      for (; begin < end; ++begin) cell.push_back(corners.index());
      (mesh_.*add)(cell);
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

  MeshInput& input_;
  FilePtr file_;
  VtkTags tags_;
  VtkXmlForm form_;
  VtkAppended appended_;
  std::string section_;
  std::vector<VtkArray> field_texts_;
  std::vector<VtpPiece> pieces_;
  MeshPlace place_;
  VtkMesh mesh_;
};

}  // namespace

TriangleMesh read_vtp(MeshInput& input) { return VtpReader(input).read(); }

}  // namespace isoweave::mesh_io
