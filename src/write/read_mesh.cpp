// Tells the format of a mesh file by its content, then by its name.
#include "isoweave/mesh.hpp"
#include "write/mesh_input.hpp"

namespace isoweave {
namespace {

using mesh_io::MeshInput;

bool starts_with_word(std::string_view head, std::string_view word) {
  return head.starts_with(word) && (head.size() == word.size() || mesh_io::is_blank(head[word.size()]));
}

bool has_ending(const std::string& path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  const std::string_view tail = std::string_view(path).substr(path.size() - ending.size());
  for (std::size_t i = 0; i < ending.size(); ++i) {
    const char c = tail[i] >= 'A' && tail[i] <= 'Z' ? static_cast<char>(tail[i] - 'A' + 'a') : tail[i];
    if (c != ending[i]) return false;
  }
  return true;
}

// The first statement after comments and empty lines is one that begins OBJ files.
bool looks_like_obj(std::string_view head) {
  while (!head.empty()) {
    std::string_view line = head.substr(0, head.find('\n'));
    head.remove_prefix(std::min(head.size(), line.size() + 1));
    const std::string_view word = mesh_io::take_word(line);
    if (word.empty() || word.front() == '#') continue;
    for (const std::string_view known : {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"}) {
      if (word == known) return true;
    }
    return false;
  }
  return false;
}

}  // namespace

TriangleMesh read_mesh(const std::string& path) {
  MeshInput input(path);
  if (input.size() == 0) input.fail("is empty, expected a mesh file");
  const std::string head = input.head(4096);
  const bool named_obj = has_ending(path, ".obj");
  if (starts_with_word(head, "ply")) return mesh_io::read_ply(input);
  if (head.starts_with("glTF")) return mesh_io::read_glb(input);
  if (head.starts_with("PK\3\4")) return mesh_io::read_3mf(input);
  if (head.find("<VTKFile") != std::string::npos) return mesh_io::read_vtp(input);
  if (starts_with_word(head, "OFF") || starts_with_word(head, "NOFF")) return mesh_io::read_off(input);
  if (!named_obj && mesh_io::is_binary_stl(input)) return mesh_io::read_stl_binary(input);
  if (!named_obj && starts_with_word(head, "solid")) return mesh_io::read_stl_ascii(input);
  if (has_ending(path, ".stl")) return mesh_io::read_stl_binary(input);
  if (has_ending(path, ".ply")) input.fail("does not begin with the line 'ply'");
  if (has_ending(path, ".glb")) input.fail("does not begin with 'glTF'");
  if (has_ending(path, ".vtp")) input.fail("does not begin with a '<VTKFile' tag");
  if (has_ending(path, ".3mf")) input.fail("does not begin as a zip archive does");
  if (has_ending(path, ".off")) input.fail("does not begin with the line 'OFF' or 'NOFF'");
  if (named_obj || looks_like_obj(head)) return mesh_io::read_obj(input);
  input.fail("is not a PLY, STL, OBJ, OFF, VTP, GLB or 3MF file");
}

}  // namespace isoweave
