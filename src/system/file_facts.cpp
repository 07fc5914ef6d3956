#include "system/file_facts.hpp"

#include <sys/stat.h>

namespace isoweave::system {

std::optional<FileFacts> facts_of_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
#ifdef __APPLE__
  const timespec& changed = status.st_mtimespec;
#else
  const timespec& changed = status.st_mtim;
#endif
  return FileFacts{static_cast<std::uint64_t>(status.st_size), changed.tv_sec, changed.tv_nsec};
}

}  // namespace isoweave::system
