#include "files/external_files.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "files/input_file.hpp"
#include "files/quoted.hpp"

namespace isoweave {

void check_external(const OpenOptions& options, std::string_view path, std::string_view name) {
  if (!options.external) bad_input(path, "a file that names no other, as --no-external asks", in_quotes(name));
}

void check_within(const std::string& path, const std::string& folder) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::weakly_canonical(path, error);
  const std::filesystem::path root = error ? real : std::filesystem::canonical(folder, error);
  const auto [in_root, in_real] = std::mismatch(root.begin(), root.end(), real.begin(), real.end());
  if (error || in_root != root.end()) {
    bad_input(path, "a file inside " + in_quotes(folder) + ", as --no-external asks", "a link that leads out of it");
  }
}

}  // namespace isoweave
