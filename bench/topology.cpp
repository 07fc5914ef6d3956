// The topology that extractors give to grids whose topology is known: the verification sets of Custodio, Etiene,
// Pesco and Silva (Practical considerations on the topological correctness of Marching Cubes 33, 2013), where a folder
// holds them.
//
//   bench_topology FOLDER
//
// Prints a table in Markdown: of how many grids an extractor gives another Euler number, number of components or genus
// than the trilinear interpolant has. (`dual` has that of `cubes`.) Names the grids to which `trilinear` gives another,
// and ends with 1 then. The folder holds the sets as their authors publish them:
//
//   MarchingCubes_cases/Grids/N-scalar_field.iso, MarchingCubes_cases/Grid_invariants/N-euler_number.txt: open volumes
//   Closed_Surfaces/Grids/N-scalar_field.iso, Closed_Surfaces/InvariantsGrid/N-invariant_grid.txt: components and genus
//
// A grid has three int32, the samples along each axis, six float32 that are not used here, and float32 samples, x
// fastest. Inside is above 0.
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"

namespace {

using namespace isoweave;
namespace fs = std::filesystem;

struct Extractor {
  ExtractorKind kind;
  const char* name;
};

constexpr std::array<Extractor, 3> kExtractors{{{ExtractorKind::kCubes, "cubes"},
                                                {ExtractorKind::kTrilinear, "trilinear"},
                                                {ExtractorKind::kTetrahedra, "tetrahedra"}}};

struct Grid {
  std::array<std::int32_t, 3> dims{};
  std::vector<float> samples;
};

Grid read_grid(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  Grid grid;
  std::array<float, 6> box{};
  file.read(reinterpret_cast<char*>(grid.dims.data()), sizeof grid.dims);
  file.read(reinterpret_cast<char*>(box.data()), sizeof box);
  std::uintmax_t count = 1;
  for (const std::int32_t dim : grid.dims) count *= static_cast<std::uintmax_t>(dim);
  const std::uintmax_t expected = sizeof grid.dims + sizeof box + count * sizeof(float);
  if (!file || fs::file_size(path) != expected) throw std::runtime_error(path.string() + ": not a grid of the sets");
  grid.samples.resize(count);
  file.read(reinterpret_cast<char*>(grid.samples.data()), static_cast<std::streamsize>(count * sizeof(float)));
  return grid;
}

std::vector<std::int64_t> read_numbers(const fs::path& path, std::size_t count) {
  std::ifstream file(path);
  std::vector<std::int64_t> numbers(count);
  for (std::int64_t& number : numbers) file >> number;
  if (!file) throw std::runtime_error(path.string() + ": expected " + std::to_string(count) + " numbers");
  return numbers;
}

// The samples of a grid as a volume.
class GridSource final : public SliceSource {
 public:
  explicit GridSource(const Grid& grid) : grid_(grid) {
    info_.path = "grid";
    info_.type = SampleType::kFloat32;
    for (std::size_t axis = 0; axis < 3; ++axis) info_.dims[axis] = grid.dims[axis];
  }

  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t, std::span<std::byte> out) override {
    const auto* const bytes = reinterpret_cast<const std::byte*>(grid_.samples.data());
    std::copy_n(bytes + static_cast<std::size_t>(first) * info_.slice_bytes(), out.size(), out.begin());
  }

 private:
  const Grid& grid_;
  VolumeInfo info_;
};

MeshCheck surface_of(const Grid& grid, ExtractorKind extractor, bool closed) {
  GridSource volume(grid);
  SurfaceOptions surface;
  surface.closed = closed;
  surface.extractor = extractor;
  MeshInMemory mesh;
  RunControl control;
  control.threads = 1;
  mesh_volume(volume, mesh, full_surface(surface), control);
  return check_mesh(mesh.copy());
}

// A set: where it lies, and in how many ways the surface of one of its grids differs from the truth.
struct Set {
  const char* grids;
  const char* truths;
  const char* ending;
  bool closed;
};

constexpr Set kCells{"MarchingCubes_cases/Grids", "MarchingCubes_cases/Grid_invariants", "-euler_number.txt", false};
constexpr Set kClosed{"Closed_Surfaces/Grids", "Closed_Surfaces/InvariantsGrid", "-invariant_grid.txt", true};

struct Wrong {
  std::uint64_t euler_number = 0, components = 0, genus = 0;
};

// Adds how a surface differs from the truth. Returns whether it does.
bool add_difference(const Set& set, const MeshCheck& found, const fs::path& truth, Wrong& wrong) {
  if (!set.closed) {
    const bool differs = found.euler != read_numbers(truth, 1)[0];
    wrong.euler_number += differs ? 1U : 0U;
    return differs;
  }
  const std::vector<std::int64_t> numbers = read_numbers(truth, 2);
  const auto components = static_cast<std::int64_t>(found.components);
  const bool has_others = components != numbers[0];
  const bool has_other_genus = components - found.euler / 2 != numbers[1];
  wrong.components += has_others ? 1U : 0U;
  wrong.genus += has_other_genus ? 1U : 0U;
  return has_others || has_other_genus;
}

// Compares all grids of a set. Returns how many there are.
std::uint64_t compare_all(const Set& set, const fs::path& folder, std::array<Wrong, 3>& wrong) {
  const std::string ending = "-scalar_field.iso";
  std::uint64_t count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / set.grids)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(ending)) continue;
    const Grid grid = read_grid(entry.path());
    const fs::path truth = folder / set.truths / (name.substr(0, name.size() - ending.size()) + set.ending);
    for (std::size_t n = 0; n < kExtractors.size(); ++n) {
      const ExtractorKind kind = kExtractors[n].kind;
      const bool differs = add_difference(set, surface_of(grid, kind, set.closed), truth, wrong[n]);
      if (differs && kind == ExtractorKind::kTrilinear) std::fprintf(stderr, "differs: %s\n", entry.path().c_str());
    }
    ++count;
  }
  return count;
}

int run(const fs::path& folder) {
  std::array<Wrong, 3> cells{}, closed{};
  const auto cell_count = static_cast<unsigned long long>(compare_all(kCells, folder, cells));
  const auto closed_count = static_cast<unsigned long long>(compare_all(kClosed, folder, closed));
  std::printf("| wrong | of %llu cells: Euler number | of %llu closed: components | genus |\n|---|---:|---:|---:|\n",
              cell_count, closed_count);
  for (std::size_t n = 0; n < kExtractors.size(); ++n) {
    std::printf(
        "| `%s` | %llu | %llu | %llu |\n", kExtractors[n].name, static_cast<unsigned long long>(cells[n].euler_number),
        static_cast<unsigned long long>(closed[n].components), static_cast<unsigned long long>(closed[n].genus));
  }
  const bool right = cells[1].euler_number + closed[1].components + closed[1].genus == 0;
  return right && cell_count + closed_count > 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) try {
  if (count != 2) throw std::invalid_argument("expected the folder of the sets");
  return run(words[1]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_topology: %s\n", error.what());
  return 2;
}
