// Puts the input into the folder of a small mesh by tasks: its first byte chooses the mesh and the file, the rest is
// what lies behind the beginning of that file, under a checksum that fits. The folder is refused, or the mesh is
// collected.
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "input_files.hpp"
#include "task_meshes.hpp"

namespace {

using namespace isoweave;

void put(const std::string& path, const std::string& whole) {
  const std::uint32_t crc = add_to_crc(0, std::as_bytes(std::span(whole)));
  std::ofstream(path, std::ios::binary) << whole << std::string_view(reinterpret_cast<const char*>(&crc), sizeof crc);
}

std::size_t chosen = 0;

void finish(const std::string& folder) {
  const TaskMesh mesh = fuzz::task_mesh(chosen, folder);
  const std::uint64_t count = list_tasks(mesh).count();
  for (std::uint64_t task = 0; task < count; ++task) do_task(mesh, task, fuzz::alone());
  fuzz::ForgetfulSink fine, coarse;
  MeshSink* const sinks[] = {&fine, &coarse};
  collect_tasks(mesh, std::span(sinks).last(mesh.options.levels.size() + 1), fuzz::alone());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFiles files("/:a/b");
  static const std::string folder = files.path() + "/tasks";
  static const std::vector<fuzz::TaskFiles> stages = [] {
    std::filesystem::create_directory(folder);
    std::vector<fuzz::TaskFiles> all;
    for (std::size_t number = 0; number < fuzz::kTaskMeshes; ++number) all.push_back(fuzz::first_stage(number, folder));
    return all;
  }();
  if (size == 0) return 0;
  chosen = data[0] % fuzz::kTaskMeshes;
  const fuzz::TaskFiles& stage = stages[chosen];
  const bool is_rest = data[0] / fuzz::kTaskMeshes % 2 == 0;
  const std::string body(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  for (std::size_t task = 0; task < stage.rest.size(); ++task) {
    put(rest_file(folder, task), stage.rest[task]);
    put(final_file(folder, task), stage.final[task]);
  }
  const std::string& chosen_file = is_rest ? stage.rest[0] : stage.final[0];
  put(is_rest ? rest_file(folder, 0) : final_file(folder, 0), chosen_file.substr(0, stage.beginning) + body);
  fuzz::expect_bad_input_at_worst(finish, folder);
  return 0;
}
