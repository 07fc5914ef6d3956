// Where the time of a device goes: the stages of a volume's way through it, one after the other, each waited for.
//
//   bench_device VOLUME ISO ERROR [--slab N] [--host] [--runs N]
//
// VOLUME is a file or generate:KIND:WxHxD, of uint8; ERROR is in mean voxels. The whole volume is one slab unless
// another is asked for. --host runs the passes on processors, to see that they run. Prints JSON: medians over the runs,
// in milliseconds, of every stage, rounds, counts, bytes held, and the digest.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "device/bulk_engine.hpp"
#include "device/cuda_engine.hpp"
#include "device/simulated_device.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "pipeline/task.hpp"
#include "volume/axes.hpp"

namespace {

using namespace isoweave;

struct Arguments {
  std::string volume;
  double iso = 0;
  double error = 0.2;
  std::int64_t slab = std::int64_t{1} << 40;
  int runs = 5;
  bool host = false;
};

class Stages {
 public:
  template <class Work>
  void time(const std::string& stage, const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    sums_[stage] += spent.count();
  }

  const std::map<std::string, double>& sums() const { return sums_; }

 private:
  std::map<std::string, double> sums_;
};

struct Run {
  Stages stages;
  std::uint64_t rounds = 0, extracted = 0, triangles = 0, bytes = 0, digest = 0;
  DecisionCounts decisions;
};

BulkOptions bulk_options(const Arguments& arguments, const VolumeInfo& volume) {
  MeshOptions options;
  options.iso = arguments.iso;
  const double voxel = mean_voxel(volume.geometry);
  const double a0 = voxel * voxel;
  return {volume,
          stored_rule(volume, options),
          false,
          {VertexNumbering::of_cube_edges(volume.dims), a0, retire_cost(arguments.error * voxel, a0)}};
}

std::unique_ptr<SliceSource> open(const std::string& volume) {
  char kind[32];
  GenerateOptions options;
  options.type = SampleType::kUint8;
  auto& [width, height, depth] = options.dims;
  if (std::sscanf(volume.c_str(), "generate:%31[^:]:%ldx%ldx%ld", kind, &width, &height, &depth) != 4) {
    return open_volume(volume, {});
  }
  options.kind = kind;
  return generate_volume(options);
}

std::unique_ptr<DeviceEngine> make_engine(const Arguments& arguments, const VolumeInfo& volume,
                                          const Executor& executor) {
  const BulkOptions options = bulk_options(arguments, volume);
  if (!arguments.host) return make_cuda_engine(options);
  return std::make_unique<BulkEngine<HostDevice>>(HostDevice(executor), options);
}

Point point(const Vec3& p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

// In the volume's index space times spacing, as --space index writes it.
std::uint64_t digest_of(const FinalPiece& piece) {
  const std::size_t known = piece.known.size();
  const auto corner = [&](std::uint32_t v) {
    return point(v < known ? piece.known[v].position : piece.positions[v - known]);
  };
  std::uint64_t digest = 0;
  for (const auto& [a, b, c] : piece.triangles) digest += triangle_digest(corner(a), corner(b), corner(c));
  return digest;
}

Run run_once(const Arguments& arguments, const Executor& executor) {
  const auto source = open(arguments.volume);
  const std::unique_ptr<DeviceEngine> engine = make_engine(arguments, source->info(), executor);
  SliceWindow window(*source, engine->slices_for(1).first);
  Run run;
  FinalPiece piece;
  std::uint64_t written = 0;
  while (engine->layers_left() > 0) {
    const std::int64_t layers = std::min({arguments.slab, engine->layers_left(), engine->most_layers()});
    const auto [first, end] = engine->slices_for(layers);
    run.stages.time("read", [&] { window.advance(first, end); });
    run.stages.time("upload and extract", [&] {
      engine->upload(window, layers);
      run.extracted += engine->extract(layers, ~std::uint64_t{0}).triangles;
    });
    run.stages.time("append", [&] { engine->append(); });
    run.stages.time("decide", [&] { engine->decide(); });
    run.bytes = std::max(run.bytes, engine->bytes());
    run.stages.time("take final", [&] { engine->take_final({written, 0}, piece); });
    written += piece.positions.size();
    run.triangles += piece.triangles.size();
    run.digest += digest_of(piece);
  }
  run.rounds = engine->rounds();
  run.decisions = engine->decisions();
  return run;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Arguments parse(int count, char** values) {
  if (count < 4) throw std::invalid_argument("expected VOLUME ISO ERROR [--slab N] [--host] [--runs N]");
  Arguments arguments{.volume = values[1], .iso = std::stod(values[2]), .error = std::stod(values[3])};
  for (int n = 4; n < count; ++n) {
    const std::string name = values[n];
    if (name == "--host") {
      arguments.host = true;
    } else if (n + 1 < count && name == "--slab") {
      arguments.slab = std::stoll(values[++n]);
    } else if (n + 1 < count && name == "--runs") {
      arguments.runs = std::stoi(values[++n]);
    } else {
      throw std::invalid_argument("expected --slab N, --host or --runs N, found " + name);
    }
  }
  return arguments;
}

}  // namespace

int main(int count, char** values) {
  try {
    const Arguments arguments = parse(count, values);
    const Executor executor;
    std::vector<Run> runs;
    for (int n = 0; n < arguments.runs; ++n) runs.push_back(run_once(arguments, executor));
    nlohmann::ordered_json out = {{"volume", arguments.volume},
                                  {"device", arguments.host ? "processors" : "cuda"},
                                  {"triangles_extracted", runs[0].extracted},
                                  {"triangles", runs[0].triangles},
                                  {"collapses", runs[0].decisions.collapses},
                                  {"rounds", runs[0].rounds},
                                  {"bytes", runs[0].bytes},
                                  {"digest", digest_text(runs[0].digest)}};
    for (const auto& [stage, first] : runs[0].stages.sums()) {
      std::vector<double> times;
      for (const Run& run : runs) times.push_back(run.stages.sums().at(stage));
      out["milliseconds"][stage] = median(times);
    }
    std::puts(out.dump(2).c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_device: %s\n", error.what());
    return 1;
  }
}
