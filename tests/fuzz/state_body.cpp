// Resumes a small run from the input: its first byte chooses the run, the rest is what lies behind the header of a
// saved state, under a checksum that fits. A state is refused, or the run comes to its end.
#include <array>
#include <vector>

#include "input_files.hpp"
#include "saved_runs.hpp"

namespace {

using namespace isoweave;

std::size_t chosen_run = 0;

void resume(const std::string& folder) {
  try {
    fuzz::run_saved(chosen_run, folder, true);
  } catch (const OverMemory&) {
  }
}

std::array<std::string, fuzz::kSavedRuns> headers(const std::string& folder) {
  std::array<std::string, fuzz::kSavedRuns> headers;
  for (std::size_t run = 0; run < headers.size(); ++run) headers[run] = fuzz::save_run(run, folder).header;
  return headers;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFiles files("/:state-1");
  static const std::array<std::string, fuzz::kSavedRuns> saved = headers(files.path());
  if (size == 0) return 0;
  chosen_run = data[0] % saved.size();
  fuzz::put_state({saved[chosen_run], {data + 1, data + size}}, files.path());
  fuzz::expect_bad_input_at_worst(resume, files.path());
  return 0;
}
