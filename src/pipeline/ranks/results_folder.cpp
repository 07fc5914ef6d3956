#include "pipeline/ranks/results_folder.hpp"

#include <filesystem>
#include <system_error>
#include <vector>

#include "isoweave/ranks.hpp"

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

std::optional<TaskIdentity> identity_of_results(const std::string& folder) {
  const std::vector<std::filesystem::path> results = results_in(folder, ".rest");
  if (results.empty()) return std::nullopt;
  StateReader reader(results.front().string(), "file of a task");
  return TaskIdentity::read(reader);
}

std::optional<std::int64_t> block_size_of_results(const std::string& folder) {
  const std::optional<TaskIdentity> identity = identity_of_results(folder);
  return identity ? std::optional(identity->block) : std::nullopt;
}

void remove_results(const std::string& folder) {
  std::error_code ignored;
  for (const char* const kind : {".rest", ".final"}) {
    for (const std::filesystem::path& result : results_in(folder, kind)) std::filesystem::remove(result, ignored);
  }
}

}  // namespace isoweave
