#include "options/input_mesh.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "isoweave/weld.hpp"
#include "options/files.hpp"
#include "report/print.hpp"

namespace isoweave::cli {

void add_weld_option(CLI::App& verb, bool& weld) {
  verb.add_flag("--weld", weld,
                "Make one vertex of all that have equal coordinates; normals and values are those of the first");
}

void add_external_option(CLI::App& verb, ReadMeshOptions& options) {
  verb.add_flag_callback(
      "--no-external", [&options] { options.external = false; },
      "Refuse a mesh file that names other files: for files from strangers");
}

TriangleMesh read_named_mesh(const std::string& path, const ReadMeshOptions& options) {
  return read_mesh(input_file(path), options);
}

InputMesh read_input_mesh(const std::string& path, const ReadMeshOptions& options, bool weld) {
  InputMesh input{read_named_mesh(path, options)};
  if (weld) input.welded = weld_vertices(input.mesh);
  return input;
}

std::vector<std::string> mesh_warnings(const std::string& path, const TriangleMesh& mesh) {
  std::vector<std::string> warnings;
  for (const std::string& note : mesh.notes) warnings.push_back(fmt::format("{}: {}", path, note));
  return warnings;
}

void print_mesh_warnings(const std::string& path, const TriangleMesh& mesh) {
  for (const std::string& warning : mesh_warnings(path, mesh)) print_note("warning: " + warning);
}

void print_welded(const std::string& path, bool weld, std::uint64_t welded) {
  if (weld)
    print_note(fmt::format("{}: {} vertices welded to others with the same coordinates", path, grouped(welded)));
}

std::vector<std::string> seam_warnings(const std::string& path, std::uint64_t seam_edges) {
  if (seam_edges == 0) return {};
  return {fmt::format("{}: {} border edges lie on others: vertices are doubled at seams, which --weld closes", path,
                      grouped(seam_edges))};
}

}  // namespace isoweave::cli
