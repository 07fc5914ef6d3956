#include "system/durable_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include "system/descriptor.hpp"

namespace isoweave::system {
namespace {

int create_without_name([[maybe_unused]] const std::string& folder, [[maybe_unused]] mode_t mode) {
#ifdef O_TMPFILE
  return ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode);
#else
  errno = ENOTSUP;
  return -1;
#endif
}

}  // namespace

int create_unnamed(const std::string& folder) {
  constexpr mode_t kNewFileMode = 0666;  // the umask takes its share, as for any new file
  const int file = create_without_name(folder, kNewFileMode);
  if (file < 0 || ::access(path_of(file).c_str(), F_OK) == 0) return file;
  ::close(file);
  return -1;
}

int create_private(const std::string& folder) {
  constexpr mode_t kOwner = 0600;
  const int file = create_without_name(folder, kOwner);
  if (file >= 0) return file;
  std::string name = folder + "/isoweave.XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

std::string path_of(int descriptor) {
#ifdef __linux__
  return "/proc/self/fd/" + std::to_string(descriptor);
#else
  return "/dev/fd/" + std::to_string(descriptor);
#endif
}

bool give_name(int descriptor, const std::string& name) { return link_path(path_of(descriptor), name); }

bool link_path(const std::string& path, const std::string& name) {
  return ::linkat(AT_FDCWD, path.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

bool make_folder(const std::string& path) {
  constexpr mode_t kNewFolderMode = 0777;  // the umask takes its share
  return ::mkdir(path.c_str(), kNewFolderMode) == 0;
}

bool rename(const std::string& from, const std::string& to) { return ::rename(from.c_str(), to.c_str()) == 0; }

bool remove_name(const std::string& path) { return ::unlink(path.c_str()) == 0; }

bool sync_file(int descriptor) { return ::fsync(descriptor) == 0; }

bool sync_names(const std::string& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return opened.get() < 0 || sync_file(opened.get()) || errno == EINVAL || errno == ENOTSUP;
}

bool cut_off(int descriptor, std::uint64_t end) {
  const auto place = static_cast<off_t>(end);
  return ::ftruncate(descriptor, place) == 0 && ::lseek(descriptor, place, SEEK_SET) == place;
}

void free_bytes([[maybe_unused]] int descriptor, [[maybe_unused]] std::uint64_t first,
                [[maybe_unused]] std::uint64_t count) {
#ifdef __linux__
  ::fallocate(descriptor, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(first),
              static_cast<off_t>(count));
#endif
}

std::uint64_t copy_within_system([[maybe_unused]] int from, [[maybe_unused]] int to,
                                 [[maybe_unused]] std::uint64_t bytes) {
#ifdef __linux__
  loff_t done = 0;
  while (static_cast<std::uint64_t>(done) < bytes) {
    const std::size_t rest = static_cast<std::size_t>(bytes - static_cast<std::uint64_t>(done));
    const ssize_t copied = ::copy_file_range(from, &done, to, nullptr, rest, 0);
    if (copied <= 0 && !(copied < 0 && errno == EINTR)) break;
  }
  return static_cast<std::uint64_t>(done);
#else
  return 0;
#endif
}

std::optional<bool> try_lock(int descriptor) {
  while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return false;
    if (errno != EINTR) return std::nullopt;
  }
  return true;
}

}  // namespace isoweave::system
