// Tells the format of a mesh file by its content, then by its name.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "isoweave/mesh.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_words.hpp"
#include "parallel/float_environment.hpp"
#include "volume/formats/formats.hpp"

namespace isoweave {
namespace {

using mesh_io::MeshInput;

constexpr std::size_t kHeadBytes = 4096;
constexpr std::size_t kLongestKeyword = 40;

// Whether a path has an ending, in any case, perhaps before ".gz".
bool has_ending(const std::string& path, std::string_view ending) {
  constexpr std::string_view kPacked = ".gz";
  const std::string name = lower_case(path);
  std::string_view stem = name;
  if (stem.ends_with(kPacked)) stem.remove_suffix(kPacked.size());
  return stem.ends_with(ending);
}

// The first statement after comments and empty lines is one that begins OBJ files.
bool looks_like_obj(std::string_view text) {
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::string_view word = mesh_io::take_word(line);
    if (word.empty() || word.front() == '#') continue;
    for (const std::string_view known : {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"}) {
      if (word == known) return true;
    }
    return false;
  }
  return false;
}

bool is_plain(char c) { return c >= ' ' && c < 0x7f; }

// Text of two or four bytes per character, with its byte order mark or without.
bool is_wide_text(std::string_view head) {
  if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF")) return true;
  if (head.size() < 4) return false;
  if (head.starts_with(std::string_view("\0\0\xFE\xFF", 4))) return true;
  return (is_plain(head[0]) && head[1] == 0 && is_plain(head[2]) && head[3] == 0) ||
         (head[0] == 0 && is_plain(head[1]) && head[2] == 0 && is_plain(head[3]));
}

// The text of a file from its first word on, behind a byte order mark, blanks and lines of comment.
std::string_view text_of(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  for (;;) {
    head.remove_prefix(std::min(head.size(), head.find_first_not_of(" \t\r\n\v\f")));
    if (!head.starts_with('#')) return head;
    head.remove_prefix(std::min(head.size(), head.find_first_of("\r\n")));
  }
}

// Text that begins with 'solid'. Some programs fill the line of the name up with bytes of 0.
bool is_stl_text(const std::string& head) {
  if (mesh_io::looks_like_text(head)) return true;
  const std::string text = mesh_io::lower_case(head);
  return text.find("facet") != std::string::npos && text.find("vertex") != std::string::npos;
}

// Reads a format that its content tells, whatever the name says. Nothing for other formats.
std::optional<TriangleMesh> read_by_content(MeshInput& input, const std::string& head, bool named_obj) {
  if (head.starts_with("glTF")) return mesh_io::read_glb(input);
  if (head.starts_with("PK\3\4")) return mesh_io::read_3mf(input);
  // Before STL: legacy data that are cut off can be as long as their first numbers say, taken for a count of triangles.
  if (is_vtk_legacy(head)) return mesh_io::read_vtk(input);
  if (!named_obj && mesh_io::is_binary_stl(input)) return mesh_io::read_stl_binary(input);
  if (head.find("<VTKFile") != std::string::npos) return mesh_io::read_vtp(input);
  if (is_wide_text(head)) input.fail("expected text in ASCII or UTF-8, found UTF-16 or UTF-32");
  std::string_view rest = text_of(head);
  if (rest.starts_with('{')) return mesh_io::read_glb(input);  // an object in JSON
  const std::string_view word = mesh_io::take_word(rest);
  const std::string keyword = mesh_io::lower_case(word.substr(0, kLongestKeyword));
  if (keyword == "ply") return mesh_io::read_ply(input);
  if (mesh_io::is_off_keyword(word)) return mesh_io::read_off(input);
  if (!named_obj && keyword == "solid" && is_stl_text(head)) return mesh_io::read_stl_ascii(input);
  return std::nullopt;
}

TriangleMesh read_by_name(MeshInput& input, const std::string& path, const std::string& head, bool named_obj) {
  const bool is_text = mesh_io::looks_like_text(head);
  if (has_ending(path, ".stl")) return is_text ? mesh_io::read_stl_ascii(input) : mesh_io::read_stl_binary(input);
  if (has_ending(path, ".off") && is_text) return mesh_io::read_off(input);
  static constexpr std::array<std::array<std::string_view, 2>, 10> kBeginnings{{
      {".ply", "the line 'ply'"},
      {".glb", "'glTF'"},
      {".gltf", "'{'"},
      {".vtk", "the line '# vtk DataFile Version'"},
      {".vtp", "a '<VTKFile' tag"},
      {".pvtp", "a '<VTKFile' tag"},
      {".vtu", "a '<VTKFile' tag"},
      {".pvtu", "a '<VTKFile' tag"},
      {".3mf", "a zip archive's 'PK'"},
      {".off", "a line such as 'OFF' or 'COFF'"},
  }};
  constexpr std::size_t kShown = 8;
  const std::string found = ", found " + in_quotes(std::string_view(head).substr(0, kShown));
  for (const auto& [ending, beginning] : kBeginnings) {
    if (has_ending(path, ending)) input.fail("expected " + std::string(beginning) + " at the beginning" + found);
  }
  if (named_obj || looks_like_obj(text_of(head))) return mesh_io::read_obj(input);
  input.fail("expected PLY, STL, OBJ, OFF, VTP, VTU, VTK, GLB, glTF or 3MF" + found);
}

// Drops the normals of a mesh where one is not a number: programs write 'nan' as the normal of a vertex that has none.
// Normals are made from the triangles where a mesh has none.
void drop_bad_normals(TriangleMesh& mesh) {
  const auto bad = std::count_if(mesh.normals.begin(), mesh.normals.end(), [](const Point& normal) {
    return !(std::isfinite(normal[0]) && std::isfinite(normal[1]) && std::isfinite(normal[2]));
  });
  if (bad == 0) return;
  mesh.normals.clear();
  mesh.notes.push_back("not kept: normals, of which " + std::to_string(bad) + " are not finite");
}

// Notes that a mesh has no triangles. An empty surface is written as a mesh of nothing at all.
void note_missing_triangles(TriangleMesh& mesh) {
  if (!mesh.triangles.empty() || mesh.vertices.empty()) return;
  mesh.notes.push_back("has no triangles, but " + std::to_string(mesh.vertices.size()) +
                       " vertices: a cloud of points");
}

}  // namespace

TriangleMesh read_mesh(const std::string& path, const ReadMeshOptions& options) {
  const StandardFloats floats;
  MeshInput input(path, options);
  const std::string head = input.head(kHeadBytes);
  const bool named_obj = has_ending(path, ".obj");
  std::optional<TriangleMesh> told = read_by_content(input, head, named_obj);
  TriangleMesh mesh = told ? std::move(*told) : read_by_name(input, path, head, named_obj);
  drop_bad_normals(mesh);
  note_missing_triangles(mesh);
  return mesh;
}

}  // namespace isoweave
