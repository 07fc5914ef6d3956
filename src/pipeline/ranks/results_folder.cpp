// The folder in which results of blocks are kept.
#include <filesystem>
#include <system_error>
#include <vector>

#include "isoweave/ranks.hpp"
#include "pipeline/parts/task_file.hpp"

namespace isoweave {
namespace {

std::vector<std::filesystem::path> results_in(const std::string& folder, const char* kind) {
  std::vector<std::filesystem::path> results;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == kind) results.push_back(entry.path());
  }
  return results;
}

}  // namespace

std::optional<std::int64_t> block_size_of_results(const std::string& folder) {
  const std::vector<std::filesystem::path> results = results_in(folder, ".rest");
  if (results.empty()) return std::nullopt;
  StateReader reader(results.front().string(), "file of a task");
  return TaskIdentity::read(reader).block;
}

void remove_results(const std::string& folder) {
  std::error_code ignored;
  for (const char* const kind : {".rest", ".final"}) {
    for (const std::filesystem::path& result : results_in(folder, kind)) std::filesystem::remove(result, ignored);
  }
}

}  // namespace isoweave
