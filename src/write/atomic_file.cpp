#include "write/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

#include "isoweave/error.hpp"
#include "text/printable.hpp"

namespace isoweave {
namespace {

// Random letters for a name; the outcome of a run does not depend on them.
std::string random_letters(std::size_t count) {
  static constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device device;
  std::string text;
  for (std::size_t n = 0; n < count; ++n) text += kLetters[device() % kLetters.size()];
  return text;
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  struct stat status {};
  // Renaming over a device or folder would fail late, or succeed and break the device.
  if (::stat(path_.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    throw CannotWrite(printable(path_) + ": expected a regular file or none, found " +
                      (S_ISDIR(status.st_mode) ? "a directory" : "a device, pipe or socket"));
  }
  create_partial();
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(partial_.c_str());
}

void AtomicFile::create_partial() {
  // Leaves room for the other parts in a name of at most 255 bytes.
  constexpr std::size_t kLongestName = 200;
  const std::string name = std::filesystem::path(path_).filename().string().substr(0, kLongestName);
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    partial_ = folder_of(path_) + "/." + name + "." + random_letters(6) + ".partial";
    // Not mkstemp: the file shall have the permissions that the user's umask asks for.
    descriptor_ = ::open(partial_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    if (errno != EEXIST) break;
  }
  fail("cannot be created");
}

void AtomicFile::fail(std::string_view action) const {
  throw CannotWrite(printable(path_) + ": " + std::string(action) + ": " + std::strerror(errno));
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t put =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) fail("cannot be written");
    done += static_cast<std::size_t>(put);
  }
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  write_at(size_, bytes);
  size_ += bytes.size();
}

void AtomicFile::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void AtomicFile::rewrite(std::uint64_t offset, std::span<const std::byte> bytes) { write_at(offset, bytes); }

void AtomicFile::commit() {
  if (::fsync(descriptor_) != 0) fail("cannot be brought to disk");
  if (::rename(partial_.c_str(), path_.c_str()) != 0) fail("cannot be renamed to");
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed != 0) fail("cannot be closed");
  // Makes the new name survive a power cut; a folder that cannot be synced does not make the file wrong.
  const int folder = ::open(folder_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

}  // namespace isoweave
