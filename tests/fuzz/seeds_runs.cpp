// Seeds of what runs leave: states, and the files of tasks.
#include "header_helpers.hpp"
#include "saved_runs.hpp"
#include "seeds.hpp"
#include "task_meshes.hpp"

namespace isoweave::fuzz {

using testing::TempFolder;

void put_state_bodies(Seeds& seeds) {
  for (std::size_t run = 0; run < kSavedRuns; ++run) {
    const TempFolder folder;
    seeds.put("state_body", static_cast<char>(run) + save_run(run, folder / "").body);
  }
}

void put_task_bodies(Seeds& seeds) {
  for (std::size_t number = 0; number < kTaskMeshes; ++number) {
    const TempFolder folder;
    const TaskFiles files = first_stage(number, folder / "");
    seeds.put("task_body", static_cast<char>(number) + files.rest[0].substr(files.beginning));
    seeds.put("task_body", static_cast<char>(number + kTaskMeshes) + files.final[0].substr(files.beginning));
  }
}

}  // namespace isoweave::fuzz
