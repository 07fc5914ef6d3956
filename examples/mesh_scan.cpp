// Meshes a volume and checks the result. Without arguments: a generated volume, into the current folder.
#include <exception>
#include <iostream>
#include <string>

#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"

int main(int argc, char** argv) try {
  const std::string path = argc > 2 ? argv[2] : "example.ply";
  const auto volume = argc > 2 ? isoweave::open_volume(argv[1]) : isoweave::generate_volume({.kind = "gyroid"});
  const auto file = isoweave::open_mesh_file(path);
  isoweave::MeshOptions options;
  options.iso = argc > 3 ? std::stod(argv[3]) : 0;
  const isoweave::MeshReport report = isoweave::mesh_volume(*volume, *file, options);
  std::cout << report.triangles << " of " << report.triangles_extracted << " triangles, digest "
            << isoweave::digest_text(report.digest) << '\n';
  const isoweave::MeshCheck check = isoweave::check_mesh(isoweave::read_mesh(path));
  return check.open_edges == 0 && check.nonmanifold_edges == 0 && check.digest == report.digest ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "mesh_scan: " << error.what() << '\n';
  return 1;
}
