#include "files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "files/printable.hpp"
#include "isoweave/error.hpp"

namespace isoweave {

void bad_input(std::string_view path, std::string_view message) {
  throw BadInput(printable(path) + ": " + printable(message));
}

void bad_input(std::string_view path, std::string_view expected, std::string_view found) {
  bad_input(path, "expected " + std::string(expected) + ", found " + std::string(found));
}

std::string InputFile::head(std::size_t limit) const {
  std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(limit, size_)), '\0');
  text.resize(read_at(0, std::as_writable_bytes(std::span(text))));
  return text;
}

std::string InputFile::size_text() const {
  const std::string bytes = std::to_string(size_);
  return knows_size() ? bytes : "at most " + bytes + " once inflated";
}

DescriptorFile::DescriptorFile(int descriptor, std::string path, std::uint64_t size, bool unnamed)
    : InputFile(std::move(path), size), descriptor_(descriptor), unnamed_(unnamed) {
  static_cast<void>(::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_SEQUENTIAL));  // advice: nothing depends on it
}

DescriptorFile::~DescriptorFile() { ::close(descriptor_); }

void DescriptorFile::forget(std::uint64_t offset, std::uint64_t bytes) const {
  static_cast<void>(
      ::posix_fadvise(descriptor_, static_cast<off_t>(offset), static_cast<off_t>(bytes), POSIX_FADV_DONTNEED));
}

std::size_t DescriptorFile::read_at(std::uint64_t offset, std::span<std::byte> out) const {
  if (offset >= size()) return 0;
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t got = ::pread(descriptor_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) bad_input(path(), std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string DescriptorFile::system_path() const {
  return unnamed_ ? "/proc/self/fd/" + std::to_string(descriptor_) : path();
}

FilePtr open_file(const std::string& path, std::string_view wanted) {
  // Without O_NONBLOCK, opening a named pipe would wait for a writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) bad_input(path, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  const bool known = ::fstat(descriptor, &status) == 0;
  const int error = errno;
  if (known && S_ISREG(status.st_mode) && status.st_size > 0) {
    return std::make_shared<DescriptorFile>(descriptor, path, static_cast<std::uint64_t>(status.st_size), false);
  }
  ::close(descriptor);
  if (!known) bad_input(path, std::string("cannot be examined: ") + std::strerror(error));
  if (S_ISDIR(status.st_mode)) bad_input(path, wanted, "a directory");
  if (!S_ISREG(status.st_mode)) bad_input(path, "a regular file", "a device, pipe or socket");
  bad_input(path, wanted, "an empty file");
}

std::string beside(const std::string& header_path, const std::string& name) {
  // operator/ keeps an absolute name as it is.
  return (std::filesystem::path(header_path).parent_path() / name).string();
}

}  // namespace isoweave
