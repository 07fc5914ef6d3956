#include "system/descriptor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>

namespace isoweave::system {
namespace {

constexpr mode_t kNewFileMode = 0666;

int flags_of(Opening how) {
  switch (how) {
    case Opening::kRead:
      return O_RDONLY;
    case Opening::kReadAtOnce:
      return O_RDONLY | O_NONBLOCK;
    case Opening::kWrite:
      return O_RDWR;
    case Opening::kWriteOrCreate:
      return O_RDWR | O_CREAT;
    case Opening::kCreateNew:
      return O_RDWR | O_CREAT | O_EXCL;
    case Opening::kCreateEmpty:
      return O_RDWR | O_CREAT | O_TRUNC;
  }
  return O_RDONLY;
}

// Calls write(bytes left, their offset) until nothing is left.
template <class Write>
bool write_all_by(const Write& write, std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(bytes, offset);
    if (written == 0) errno = ENOSPC;
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  return true;
}

}  // namespace

int open_descriptor(const std::string& path, Opening how) {
  return ::open(path.c_str(), flags_of(how) | O_CLOEXEC, kNewFileMode);
}

int duplicate(int descriptor) { return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0); }

int duplicate_standard_input() { return duplicate(STDIN_FILENO); }

bool close_descriptor(int descriptor) { return ::close(descriptor) == 0; }

std::int64_t read_at(int descriptor, std::uint64_t offset, std::span<std::byte> out) {
  while (true) {
    const ssize_t got = ::pread(descriptor, out.data(), out.size(), static_cast<off_t>(offset));
    if (got >= 0 || errno != EINTR) return got;
  }
}

std::int64_t read_once(int descriptor, std::span<std::byte> out) {
  while (true) {
    const ssize_t got = ::read(descriptor, out.data(), out.size());
    if (got >= 0 || (errno != EAGAIN && errno != EINTR)) return got;
    if (errno == EINTR) continue;
    pollfd wanted{descriptor, POLLIN, 0};
    ::poll(&wanted, 1, -1);
  }
}

bool write_all(int descriptor, std::span<const std::byte> bytes) {
  return write_all_by([&](auto left, std::uint64_t) { return ::write(descriptor, left.data(), left.size()); }, 0,
                      bytes);
}

bool write_all_at(int descriptor, std::uint64_t offset, std::span<const std::byte> bytes) {
  return write_all_by(
      [&](auto left, std::uint64_t at) {
        return ::pwrite(descriptor, left.data(), left.size(), static_cast<off_t>(at));
      },
      offset, bytes);
}

void expect_in_order([[maybe_unused]] int descriptor) {
#ifdef POSIX_FADV_SEQUENTIAL
  static_cast<void>(::posix_fadvise(descriptor, 0, 0, POSIX_FADV_SEQUENTIAL));
#endif
}

void expect_no_more([[maybe_unused]] int descriptor, [[maybe_unused]] std::uint64_t offset,
                    [[maybe_unused]] std::uint64_t bytes) {
#ifdef POSIX_FADV_DONTNEED
  static_cast<void>(
      ::posix_fadvise(descriptor, static_cast<off_t>(offset), static_cast<off_t>(bytes), POSIX_FADV_DONTNEED));
#endif
}

}  // namespace isoweave::system
