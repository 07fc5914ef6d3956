// bench_work MESH ERROR: simplifies a mesh once with isoweave and once, to as many triangles, with meshoptimizer, each
// in one thread, for a profiler that counts what they do (bench/work). Prints the numbers of collapses.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include "isoweave/pipeline.hpp"
#include "meshoptimizer.hpp"

namespace bench {
namespace {

class CountingSink : public isoweave::MeshSink {
 public:
  void append(const isoweave::MeshPiece& piece) override { triangles_ += piece.triangles.size(); }
  void finish() override {}
  std::size_t triangles() const { return triangles_; }

 private:
  std::size_t triangles_ = 0;
};

void run(const std::string& path, double error) {
  const isoweave::TriangleMesh full = isoweave::read_mesh(path);
  isoweave::RunControl control;
  control.threads = 1;
  control.measure = false;
  CountingSink sink;
  const isoweave::MeshReport report = simplify_mesh(full, sink, {.error = isoweave::Length::units(error)}, control);
  const std::size_t left = meshoptimizer_simplify(flat_indices(full), full.vertices, sink.triangles(), 0).size() / 3;
  // An edge inside the surface takes two triangles with it.
  std::printf("isoweave %llu\nmeshoptimizer %zu\n", static_cast<unsigned long long>(report.collapses),
              (full.triangles.size() - left) / 2);
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw std::runtime_error("usage: bench_work MESH ERROR");
    bench::run(argv[1], std::atof(argv[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_work: %s\n", error.what());
    return 1;
  }
}
