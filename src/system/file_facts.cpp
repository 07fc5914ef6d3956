#include "system/file_facts.hpp"

#include <glob.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace isoweave::system {
namespace {

FileStatus::Kind kind_of(mode_t mode) {
  if (S_ISREG(mode)) return FileStatus::Kind::kRegular;
  if (S_ISDIR(mode)) return FileStatus::Kind::kFolder;
  return S_ISFIFO(mode) || S_ISSOCK(mode) ? FileStatus::Kind::kPipe : FileStatus::Kind::kOther;
}

FileStatus status_from(const struct stat& status) {
  return {kind_of(status.st_mode), static_cast<std::uint64_t>(status.st_size),
          static_cast<std::uint64_t>(status.st_nlink), static_cast<std::uint64_t>(status.st_dev),
          static_cast<std::uint64_t>(status.st_ino)};
}

// A folder that is not there holds no match; one that may not be listed might.
int gives_up(const char*, int error) { return error == ENOENT || error == ENOTDIR ? 0 : 1; }

}  // namespace

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

std::optional<FileStatus> status_of(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return std::nullopt;
  return status_from(status);
}

std::optional<FileStatus> status_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return status_from(status);
}

std::string follow_links(const std::string& path) {
  constexpr int kMostLinks = 40;  // as the kernel has it
  std::error_code error;
  std::filesystem::path target = path;
  for (int links = 0; std::filesystem::is_symlink(target, error) && links < kMostLinks; ++links) {
    target = target.parent_path() / std::filesystem::read_symlink(target, error);
  }
  return target.string();
}

bool may_write(const std::string& path) { return ::access(path.c_str(), W_OK) == 0; }

std::optional<std::vector<std::string>> names_like(const std::string& pattern) {
  glob_t found{};
  const int result = ::glob(pattern.c_str(), GLOB_NOSORT, gives_up, &found);
  std::vector<std::string> names;
  for (std::size_t n = 0; result == 0 && n < found.gl_pathc; ++n) names.emplace_back(found.gl_pathv[n]);
  ::globfree(&found);
  if (result != 0 && result != GLOB_NOMATCH) return std::nullopt;
  return names;
}

}  // namespace isoweave::system
