// The meshes that check, compare, render, simplify and view read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"
#include "options/cli_app.hpp"

namespace isoweave::cli {

inline constexpr const char* kMeshInputHelp =
    "Mesh to read: PLY, STL, OBJ, OFF, VTP, VTU, VTK, GLB, glTF or 3MF, in gzip too; - is standard input";

void add_weld_option(CLI::App& verb, bool& weld);

struct InputMesh {
  TriangleMesh mesh;
  std::uint64_t welded = 0;  // vertices that --weld has taken away
};

void add_external_option(CLI::App& verb, ReadMeshOptions& options);

// The mesh that a user names.
TriangleMesh read_named_mesh(const std::string& path, const ReadMeshOptions& options);

InputMesh read_input_mesh(const std::string& path, const ReadMeshOptions& options, bool weld);

// Notes on a mesh that was read, for the user, one line each.
std::vector<std::string> mesh_warnings(const std::string& path, const TriangleMesh& mesh);

// Prints these notes on standard error, one line each.
void print_mesh_warnings(const std::string& path, const TriangleMesh& mesh);

// Prints how many vertices were welded, if that was asked for.
void print_welded(const std::string& path, bool weld, std::uint64_t welded);

// A warning about the edges of seams, with the way to close them. Nothing where there are none.
std::vector<std::string> seam_warnings(const std::string& path, std::uint64_t seam_edges);

}  // namespace isoweave::cli
