#include "options/levels.hpp"

#include <filesystem>
#include <stdexcept>

#include "options/values.hpp"
#include "report/print.hpp"

namespace isoweave::cli {

namespace {

void check_one_file(const OutputOptions& output, const StopOptions& stop) {
  if (!stop.has_levels())
    throw std::invalid_argument(
        "--one-file: expected several levels by --lods or, of a volume, several surfaces by --iso or --labels, found "
        "none");
  const MeshFormat format = output_format(output);
  if (format == MeshFormat::kGlb || (format == MeshFormat::kPrecomputed && output.compress)) return;
  wrong_value("--one-file", "a mesh named .glb, or .precomputed with --compress", output.path);
}

// The name of a level in messages.
std::string level_name(const std::vector<OutputOptions>& outputs, std::size_t level) {
  return outputs[level].one_file ? fmt::format("{}, level {}", outputs[level].name(), level) : outputs[level].name();
}

}  // namespace

std::vector<Length> finer_levels(const StopOptions& stop, const LengthBasis& basis) {
  std::vector<Length> levels;
  if (!stop.has_levels()) return levels;
  for (const StopOptions& level : stop_levels(stop)) levels.push_back(parse_error_length("--lods", level.error, basis));
  levels.pop_back();
  return levels;
}

std::vector<OutputOptions> level_outputs(const OutputOptions& output, const StopOptions& stop) {
  if (output.one_file) check_one_file(output, stop);
  if (!stop.has_levels()) return {output};
  if (output.one_file) return std::vector<OutputOptions>(stop_levels(stop).size(), output);
  const std::filesystem::path path(output.path);
  std::vector<OutputOptions> outputs;
  for (std::size_t level = 0; level < stop_levels(stop).size(); ++level) {
    outputs.push_back(output);
    outputs.back().path =
        (path.parent_path() / fmt::format("{}_lod{}{}", path.stem().string(), level, path.extension().string()))
            .string();
  }
  return outputs;
}

void try_levels(const std::vector<OutputOptions>& outputs) {
  const LevelSinks discarded(outputs, [&](std::size_t level) { return mesh_file_options(outputs[level], {}); });
}

LevelSinks::LevelSinks(const std::vector<OutputOptions>& outputs,
                       const std::function<MeshFileOptions(std::size_t)>& options) {
  if (outputs.front().one_file) {
    std::vector<MeshFileOptions> levels;
    for (std::size_t level = 0; level < outputs.size(); ++level) levels.push_back(options(level));
    sinks_ = open_mesh_levels(outputs.front().path, levels);
  } else {
    for (std::size_t level = 0; level < outputs.size(); ++level) {
      sinks_.push_back(open_output(outputs[level], options(level)));
    }
  }
  for (const auto& sink : sinks_) pointers_.push_back(sink.get());
}

void LevelSinks::tell_digests(MeshReport& report) const {
  report.digest = file_digest(*sinks_.back(), report.digest);
  for (std::size_t level = 0; level < report.levels.size(); ++level) {
    report.levels[level].digest = file_digest(*sinks_[level], report.levels[level].digest);
  }
}

std::vector<TriangleMesh> read_finer(const std::vector<OutputOptions>& outputs) {
  std::vector<TriangleMesh> meshes;
  for (std::size_t level = 0; level + 1 < outputs.size(); ++level) meshes.push_back(read_mesh(outputs[level].path));
  return meshes;
}

Json levels_json(const MeshReport& report, const std::vector<OutputOptions>& outputs) {
  Json levels = Json::array();
  for (std::size_t level = 0; level < report.levels.size(); ++level) {
    Json json = Json::parse(surface_json(report.levels[level]));
    json["output"] = outputs[level].name();
    levels.push_back(std::move(json));
  }
  return levels;
}

void print_levels(const MeshReport& report, const std::vector<OutputOptions>& outputs) {
  for (std::size_t level = 0; level < report.levels.size(); ++level) {
    print_surface(report.levels[level], level_name(outputs, level));
  }
}

}  // namespace isoweave::cli
