// Small meshes by tasks, for what lies in the files of a task behind their beginning.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "isoweave/tasks.hpp"
#include "pipeline/parts/task_file.hpp"
#include "saved_runs.hpp"

namespace isoweave::fuzz {

inline constexpr std::size_t kTaskMeshes = 5;

inline TaskMesh task_mesh(std::size_t number, const std::string& folder) {
  MeshOptions options;
  options.iso = 127.5;
  options.error = Length::voxels(0.4);
  if (number == 1) options.closed = false;
  if (number == 2) options.levels = {Length::voxels(0.1)};
  if (number == 3) options.normals = Normals::kQuadric;
  if (number == 4) options.triangles = 200;
  BlockOptions blocks;
  blocks.size = 8;
  const auto open = [] { return generate_volume({"noise", {9, 5, 9}, SampleType::kUint8, {1, 1, 1}, 5}); };
  return {folder, open, options, blocks, number == 4 ? 0.1 : 0};
}

inline RunControl alone() {
  RunControl control;
  control.threads = 1;
  return control;
}

// The files of the first stage, without their checksums.
struct TaskFiles {
  std::vector<std::string> rest, final;
  std::size_t beginning = 0;  // bytes that tell the mesh
};

inline TaskFiles first_stage(std::size_t number, const std::string& folder) {
  const TaskMesh mesh = task_mesh(number, folder);
  const std::uint64_t tasks = list_tasks(mesh).stages.front();
  TaskFiles stage;
  const auto take = [&](const std::string& path) {
    const std::string whole = bytes_of(path);
    return whole.substr(0, whole.size() - sizeof(std::uint32_t));
  };
  for (std::uint64_t task = 0; task < tasks; ++task) {
    do_task(mesh, task, alone());
    stage.rest.push_back(take(rest_file(folder, task)));
    stage.final.push_back(take(final_file(folder, task)));
  }
  std::size_t same = 0;  // the final file of the same task begins alike
  while (stage.rest[0][same] == stage.final[0][same] && same + 1 < stage.final[0].size()) ++same;
  stage.beginning = same;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  return stage;
}

}  // namespace isoweave::fuzz
