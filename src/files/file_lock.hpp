// Locks on files, which the system releases however the process ends.
#pragma once

#include <optional>
#include <string>

#include "system/descriptor.hpp"

namespace isoweave {

// Whether a file that was locked still has its name: a process that gives up its lock removes the file.
bool keeps_name(int fd, const std::string& path);

// A file that is locked against all others for as long as this object, which removes it.
class FileLock {
 public:
  // Takes the lock, and makes the file where there is none. Nothing where another holder has it. Throws CannotWrite
  // where there are no locks.
  static std::optional<FileLock> take(const std::string& path);

  FileLock(FileLock&& other) noexcept = default;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

 private:
  FileLock(std::string path, system::Descriptor fd) : path_(std::move(path)), fd_(std::move(fd)) {}

  std::string path_;
  system::Descriptor fd_;
};

}  // namespace isoweave
