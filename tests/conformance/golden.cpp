// Digests that hold on every machine, by every instruction set that this processor has.
// Threads: none, digests of the loops that schedules.cpp has
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>

#include "extract/cell_kernels.hpp"
#include "extract/row_kernels.hpp"
#include "golden/rows.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "parallel/instruction_sets.hpp"
#include "parallel/parallel.hpp"
#include "sanitized.hpp"
#include "simplify/kernels.hpp"

namespace isoweave::testing::golden_test {
namespace {

using golden::read_rows;
using golden::renew_rows;
using golden::Row;

constexpr const char* kFile = ISOWEAVE_GOLDEN_FILE;

std::vector<std::string> split(const std::string& text, char at) {
  std::istringstream in(text);
  std::vector<std::string> parts;
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

// The options of a row, read from its arguments.
class Arguments {
 public:
  explicit Arguments(const std::vector<std::string>& words) : words_(words) {}

  bool has(const std::string& option) const { return std::ranges::find(words_, option) != words_.end(); }

  std::string value(const std::string& option, const std::string& otherwise) const {
    const auto found = std::ranges::find(words_, option);
    return found == words_.end() ? otherwise : *(found + 1);
  }

  Length length(const std::string& option, const std::string& otherwise) const {
    return parse_length(value(option, otherwise), "");
  }

  std::vector<Length> lengths(const std::string& option) const {
    std::vector<Length> list;
    for (const std::string& part : split(value(option, ""), ',')) list.push_back(parse_length(part, ""));
    return list;
  }

  Quality quality() const {
    const std::string name = value("--quality", "normal");
    return name == "fast" ? Quality::kFast : name == "fine" ? Quality::kFine : Quality::kNormal;
  }

  Normals normals() const {
    const std::string name = value("--normals", "none");
    return name == "quadric" ? Normals::kQuadric : name == "gradient" ? Normals::kGradient : Normals::kAbsent;
  }

  ExtractorKind extractor() const {
    const std::string name = value("--extractor", "cubes");
    return name == "trilinear"    ? ExtractorKind::kTrilinear
           : name == "tetrahedra" ? ExtractorKind::kTetrahedra
           : name == "dual"       ? ExtractorKind::kDual
                                  : ExtractorKind::kCubes;
  }

  int smooth() const {
    for (const std::string& word : words_) {
      if (word.starts_with("--smooth=")) return std::stoi(word.substr(9));
    }
    return has("--smooth") ? kUsualSmoothing : 0;
  }

  ComponentRule components() const { return {std::stoull(value("--min-component", "0")), has("--largest")}; }

 private:
  const std::vector<std::string>& words_;
};

// generate:KIND:WxHxD[:TYPE[:SEED]]
GenerateOptions volume_of(const std::string& text, const Arguments& arguments) {
  const std::vector<std::string> parts = split(text, ':');
  const std::vector<std::string> dims = split(parts.at(2), 'x');
  const std::vector<std::string> spacing = split(arguments.value("--spacing", "1,1,1"), ',');
  GenerateOptions volume;
  volume.kind = parts.at(1);
  for (std::size_t n = 0; n < 3; ++n) {
    volume.dims.at(n) = std::stoll(dims.at(n));
    volume.spacing.at(n) = std::stod(spacing.at(n));
  }
  if (parts.size() > 3) volume.type = parse_sample_type(parts[3]).value();
  if (parts.size() > 4) volume.seed = std::stoull(parts[4]);
  return volume;
}

// How far to simplify: `most` is the bound where there is none but a number of triangles.
template <class Options>
void set_stop(const Arguments& arguments, double most, Options& options) {
  options.quality = arguments.quality();
  options.drop_specks = arguments.value("--specks", "keep") == "drop";
  options.max_distance = arguments.length("--max-distance", "0");
  options.triangles = std::stoull(arguments.value("--triangles", "0"));
  options.error = arguments.length("--error", "0.2vox");
  if (options.triangles > 0 && !arguments.has("--error")) options.error = Length::units(most);
  options.levels = arguments.lengths("--lods");
  if (options.levels.empty()) return;
  options.error = options.levels.back();
  options.levels.pop_back();
}

MeshOptions mesh_options(const Arguments& arguments, const VolumeInfo& volume) {
  MeshOptions options;
  options.iso = std::stod(arguments.value("--iso", ""));
  options.inside_above = arguments.value("--inside", "above") == "above";
  options.closed = !arguments.has("--open");
  options.smooth = arguments.smooth();
  options.extractor = arguments.extractor();
  options.normals = arguments.normals();
  set_stop(arguments, most_shape_error(volume), options);
  return options;
}

// Meshes of rows, by their names.
using Meshes = std::map<std::string, TriangleMesh>;
using MakeMeshes = std::function<void(std::span<MeshSink* const>)>;

std::vector<std::string> digests_of(const Row& row, std::size_t levels, const MakeMeshes& make, Meshes& meshes) {
  std::vector<MeshInMemory> sinks(levels);
  std::vector<MeshSink*> pointers(levels);
  std::ranges::transform(sinks, pointers.begin(), [](MeshInMemory& sink) { return &sink; });
  make(pointers);
  std::vector<std::string> digests(levels);
  std::ranges::transform(sinks, digests.begin(),
                         [](const MeshInMemory& sink) { return digest_text(check_mesh(sink.copy()).digest); });
  meshes.at(row.name) = sinks.back().copy();
  return digests;
}

RunControl one_thread() {
  RunControl control;
  control.threads = 1;
  return control;
}

std::vector<std::string> run_row(const Row& row, Meshes& meshes) {
  const Arguments arguments(row.words);
  const std::string& input = row.words.at(1);
  if (row.words.at(0) == "simplify") {
    const TriangleMesh& mesh = meshes.at(input);
    SimplifyOptions options;
    set_stop(arguments, most_shape_error(mesh), options);
    return digests_of(
        row, options.levels.size() + 1, [&](auto sinks) { simplify_mesh(mesh, sinks, options, one_thread()); }, meshes);
  }
  const GenerateOptions volume = volume_of(input, arguments);
  MeshOptions options = mesh_options(arguments, generate_volume(volume)->info());
  const ComponentRule rule = arguments.components();
  ComponentChoice choice;
  if (!rule.keeps_all()) {
    choice = choose_components(*generate_volume(volume), options, rule, one_thread());
    options.components = borrow(choice);
  }
  return digests_of(
      row, options.levels.size() + 1,
      [&](auto sinks) { mesh_volume(*generate_volume(volume), sinks, options, one_thread()); }, meshes);
}

// All rows as they are now, by the instructions up to the n-th set. Rows run side by side, but those first whose meshes
// other rows simplify.
std::vector<Row> run_rows(const std::vector<Row>& rows, std::size_t set) {
  newest_instructions = set;
  Meshes meshes;
  std::set<std::string> inputs;
  for (const Row& row : rows) {
    meshes[row.name];
    if (row.words.at(0) == "simplify") inputs.insert(row.words.at(1));
  }
  std::vector<Row> now = rows;
  for (const bool are_inputs : {true, false}) {
    Executor().for_each(static_cast<std::int64_t>(now.size()), 1, [&](std::int64_t n) {
      Row& row = now[static_cast<std::size_t>(n)];
      if (inputs.contains(row.name) == are_inputs) row.digests = run_row(row, meshes);
    });
  }
  newest_instructions = kAllInstructions;
  return now;
}

TEST(Golden, DigestsByEveryInstructionSet) {
  const std::vector<Row> rows = read_rows(kFile);
  ASSERT_GE(rows.size(), 40U);
  if (std::getenv("ISOWEAVE_RENEW_DIGESTS") != nullptr) return renew_rows(kFile, run_rows(rows, kAllInstructions));
  const std::size_t sets = std::max({all_kernels().size(), all_row_kernels().size(), all_cell_kernels().size()});
  for (std::size_t set = kSanitized ? sets - 1 : 0; set < sets; ++set) {
    const std::vector<Row> now = run_rows(rows, set);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      EXPECT_EQ(now[n].digests, rows[n].digests) << rows[n].name << ", instruction set " << set;
    }
  }
}

// Several columns wide, which the zone holds one after the other, and a slab each its own.
TEST(Golden, DigestOfAWideVolumeInAnySlabs) {
  const std::vector<Row> rows = read_rows(kFile);
  const auto row = std::ranges::find(rows, "noise-wide", &Row::name);
  ASSERT_NE(row, rows.end());
  const Arguments arguments(row->words);
  const GenerateOptions volume = volume_of(row->words[1], arguments);
  MeshOptions options = mesh_options(arguments, generate_volume(volume)->info());
  RunControl control;
  control.threads = 3;
  for (const std::int64_t slab : {1, 7, 1000}) {
    control.slab = slab;
    MeshInMemory sink;
    mesh_volume(*generate_volume(volume), sink, options, control);
    EXPECT_EQ(digest_text(check_mesh(sink.copy()).digest), row->digests.at(0)) << slab;
  }
}

}  // namespace
}  // namespace isoweave::testing::golden_test
