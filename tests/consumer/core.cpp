// A program that links the core by itself: it meshes a volume in memory into memory, and catches exceptions by their
// base.
#include <cstdio>

#include "isoweave/error.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"

int main() {
  const isoweave::GenerateOptions volume{.kind = "gyroid"};
  isoweave::MeshInMemory sink;
  const isoweave::MeshReport report = isoweave::mesh_volume(*isoweave::generate_volume(volume), sink, {});
  const isoweave::MeshCheck check = isoweave::check_mesh(sink.copy());
  bool refused = false;
  try {
    isoweave::RunControl control;
    control.memory = 1;
    isoweave::mesh_volume(*isoweave::generate_volume(volume), sink, {}, control);
  } catch (const isoweave::Error&) {
    refused = true;
  }
  std::printf("%llu triangles\n", static_cast<unsigned long long>(report.triangles));
  return refused && report.triangles > 0 && check.open_edges == 0 && check.digest == report.digest ? 0 : 1;
}
