// Reads the input as a mesh, and checks it.
#include "isoweave/mesh.hpp"

#include "input_files.hpp"
#include "isoweave/measure.hpp"

namespace {

using namespace isoweave;

void check_file(const std::string& path) {
  const TriangleMesh mesh = read_mesh(path);
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) {
    fuzz::broken_promise("one normal per vertex, or none");
  }
  if (!mesh.values.empty() && mesh.values.size() != mesh.vertices.size()) {
    fuzz::broken_promise("one number per vertex, or none");
  }
  check_mesh(mesh);
  count_self_intersections(mesh, 10, 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFiles files(fuzz::kInputNames);
  files.put({data, size});
  fuzz::expect_bad_input_at_worst(check_file, files.path());
  return 0;
}
