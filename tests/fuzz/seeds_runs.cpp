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

// A volume of 9 x 9 x 9 bytes in memory and one by callback, and calls with the defaults.
void put_c_interface(Seeds& seeds) {
  const std::string info{"\0\x09\x09\x09\0\0\1\1\1\1\0", 11};
  std::string samples;
  for (int n = 0; n < 9 * 9 * 9; ++n) samples += static_cast<char>((n * n) % 251);
  const std::string held = std::string(1, '\0') + info + '\1' + samples;
  const std::string by_callback = '\1' + info + std::string("\1\1\1\1\0\1\1\1\xff", 9) + samples.substr(0, 256);
  for (const char choice : {'\0', '\1', '\2', '\7'}) {
    for (const std::string& seed : {held, by_callback}) {
      // Slices to be read, then the calls.
      seeds.put("c_interface", seed + std::string("\1\0\1\2\1", 5) + std::string(80, choice));
    }
  }
}

}  // namespace isoweave::fuzz
