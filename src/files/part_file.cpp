#include "files/part_file.hpp"

#include <cerrno>

#include "files/quoted.hpp"
#include "system/file_facts.hpp"

namespace isoweave {

void require_part(const std::string& whole, std::string_view role, const std::string& path) {
  if (system::status_of(path)) return;
  if (errno == ENAMETOOLONG) {
    bad_input(whole, std::string(role) + " a file",
              "a name that is too long for one, of " + std::to_string(path.size()) +
                  " bytes: " + in_quotes(path.substr(path.find_last_of('/') + 1)));
  }
  if (errno != ENOENT && errno != ENOTDIR) return;
  bad_input(whole, std::string(role) + " " + path, "no such file");
}

FilePtr open_part(const std::string& whole, std::string_view role, const std::string& path) {
  require_part(whole, role, path);
  return open_file(path);
}

}  // namespace isoweave
