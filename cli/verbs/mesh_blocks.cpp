#include "verbs/mesh_blocks.hpp"

#include <filesystem>
#include <stdexcept>

#include "isoweave/error.hpp"
#include "isoweave/possible_runs.hpp"
#include "options/files.hpp"
#include "options/values.hpp"

namespace isoweave::cli {

std::string folder_beside(const OutputOptions& output) {
  if (output.path.empty()) return std::filesystem::temp_directory_path().string();
  const std::filesystem::path folder = std::filesystem::path(output.path).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::optional<std::int64_t> asked_blocks(const MeshArguments& arguments) {
  if (arguments.blocks.empty() || arguments.blocks == "auto" || arguments.blocks == "off") return std::nullopt;
  const std::int64_t size = parse_count("--blocks", arguments.blocks, "512, auto or off");
  if (size < 8) wrong_value("--blocks", "8 cells or more, auto or off", arguments.blocks);
  return size;
}

bool may_take_blocks(const MeshArguments& arguments, const MeshOptions& options, const RunControl& control,
                     const SliceSource& volume) {
  const bool is_auto = arguments.blocks.empty() || arguments.blocks == "auto";
  if (!is_auto || control.memory == 0 || is_read_once(arguments.input.path)) return false;
  if (!volume.skips() || !volume.reads_boxes()) return false;
  if (!arguments.checkpoint.empty() || arguments.watch.given() || arguments.index.named()) return false;
  try {
    require_possible(RunKind::kBlocks, options, control);
  } catch (const ImpossibleRun&) {
    return false;
  }
  return true;
}

MeshReport mesh_input_in_blocks(const MeshArguments& arguments, std::int64_t size, std::span<MeshSink* const> sinks,
                                const MeshOptions& options, const RunControl& control) {
  RunControl in_blocks = control;
  in_blocks.index = nullptr;
  BlockOptions blocks{size};
  if (control.memory > 0) blocks.folder = folder_beside(arguments.output);
  return mesh_in_blocks([&] { return open_input(arguments.input); }, sinks, options, blocks, in_blocks);
}

}  // namespace isoweave::cli
