#include "verbs/mesh_blocks.hpp"

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "isoweave/error.hpp"
#include "isoweave/possible_runs.hpp"
#include "options/files.hpp"
#include "options/values.hpp"

namespace isoweave::cli {
namespace {

// A folder that is there for as long as this object.
class PassingFolder {
 public:
  // Throws CannotWrite where there is a file or folder of that name.
  explicit PassingFolder(std::string path) : path_(std::move(path)) {
    std::error_code error;
    if (std::filesystem::create_directory(path_, error)) return;
    throw CannotWrite(path_ + ": expected a new folder for what waits from block to block, found " +
                      (error ? error.message() : "one of that name"));
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  ~PassingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string folder_beside(const OutputOptions& output) {
  return output.path.empty() ? (std::filesystem::temp_directory_path() / "isoweave.blocks").string()
                             : output.path + ".blocks";
}

}  // namespace

std::optional<std::int64_t> asked_blocks(const MeshArguments& arguments) {
  if (arguments.blocks.empty() || arguments.blocks == "auto" || arguments.blocks == "off") return std::nullopt;
  const std::int64_t size = parse_count("--blocks", arguments.blocks);
  if (size < 8) wrong_value("--blocks", "8 cells or more, auto or off", arguments.blocks);
  return size;
}

bool may_take_blocks(const MeshArguments& arguments, const MeshOptions& options, const RunControl& control,
                     const SliceSource& volume) {
  const bool is_auto = arguments.blocks.empty() || arguments.blocks == "auto";
  if (!is_auto || control.memory == 0 || is_read_once(arguments.input.path)) return false;
  if (!volume.skips() || !volume.reads_parts_of_rows()) return false;
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
  std::optional<PassingFolder> folder;
  if (control.memory > 0) blocks.folder = folder.emplace(folder_beside(arguments.output)).path();
  return mesh_in_blocks([&] { return open_input(arguments.input); }, sinks, options, blocks, in_blocks);
}

}  // namespace isoweave::cli
