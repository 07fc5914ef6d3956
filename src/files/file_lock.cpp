#include "files/file_lock.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include "files/atomic_file.hpp"
#include "isoweave/error.hpp"
#include "system/durable_file.hpp"
#include "system/file_facts.hpp"

namespace isoweave {

bool keeps_name(int fd, const std::string& path) {
  const std::optional<system::FileStatus> locked = system::status_of(fd);
  const std::optional<system::FileStatus> named = system::status_of(path);
  return locked && named && locked->same_file(*named);
}

std::optional<FileLock> FileLock::take(const std::string& path) {
  system::Descriptor fd(system::open_descriptor(path, system::Opening::kWriteOrCreate));
  if (fd.get() < 0) throw CannotWrite(path + ": cannot be locked: " + std::generic_category().message(errno));
  if (!try_lock(fd.get(), path) || !keeps_name(fd.get(), path)) return std::nullopt;
  return FileLock(path, std::move(fd));
}

FileLock::~FileLock() {
  if (fd_.get() >= 0) system::remove_name(path_);
}

}  // namespace isoweave
