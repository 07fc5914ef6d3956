#include "files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
constexpr mode_t kNewFileMode = 0666;          // the umask takes its share, as for any new file
constexpr std::size_t kLongestNameKept = 200;  // of the 255 bytes of a name; the rest is for the decoration
constexpr int kAttempts = 100;

[[noreturn]] void cannot_write(const std::string& path, const std::string& what, int error) {
  throw CannotWrite(path + ": " + what + ": " + std::generic_category().message(error));
}

[[noreturn]] void bad_part(const std::string& path, const PartMark& mark, const std::string& found) {
  throw BadInput(path + ": expected the " + std::to_string(mark.size) +
                 " bytes that it had when the state was saved, found " + found);
}

struct OverwrittenBytes {
  std::uint64_t offset = 0;
  std::span<const std::byte> bytes;
};

// The records of the file `name`: offset, count, bytes.
std::vector<OverwrittenBytes> overwritten_in(std::span<const std::byte> saved, const std::string& name) {
  std::vector<OverwrittenBytes> records;
  while (!saved.empty()) {
    std::array<std::uint64_t, 2> place{};
    const bool has_place = saved.size() >= sizeof place;
    if (has_place) std::memcpy(place.data(), saved.data(), sizeof place);
    if (!has_place || place[1] > saved.size() - sizeof place) {
      throw BadInput(name + ": expected what was overwritten in a part, found a file that was cut off or changed");
    }
    saved = saved.subspan(sizeof place);
    records.push_back({place[0], saved.first(static_cast<std::size_t>(place[1]))});
    saved = saved.subspan(static_cast<std::size_t>(place[1]));
  }
  return records;
}

// Of all that was written to it.
std::uint32_t crc_of_file(OutputDescriptor& file) {
  std::vector<std::byte> block(static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, file.size())));
  std::uint32_t crc = 0;
  for (std::uint64_t done = 0; done < file.size(); done += block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), file.size() - done)));
    file.read_back(done, block);
    crc = add_to_crc(crc, block);
  }
  return crc;
}

std::string overwritten_name(const std::string& part) { return part + ".before"; }

// Of what is written to take the place of a file.
std::string new_name(const std::string& path) { return path + ".new"; }

// A part that has become the mesh already, under a second name, must not be written to: it goes on as a copy.
void own_part(const std::string& path, std::uint64_t size) {
  const int from = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (from < 0) cannot_write(path, "cannot be opened", errno);
  OutputDescriptor part(from, path, size);
  AtomicFile copy(path);
  copy.append(part);
  copy.commit();
}

OutputDescriptor open_part_again(const std::string& path, const PartMark& mark) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) bad_part(path, mark, std::generic_category().message(errno));
  OutputDescriptor file(fd, path, mark.size);
  struct stat status {};
  if (::fstat(fd, &status) != 0) cannot_write(path, "cannot be looked up", errno);
  const auto found = static_cast<std::uint64_t>(status.st_size);
  if (found < mark.size) bad_part(path, mark, std::to_string(found) + " bytes");
  if (status.st_nlink == 1) return file;
  own_part(path, found);
  return open_part_again(path, mark);
}

std::string name_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

std::string resolve_links(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr), &std::free);
  if (!real) cannot_write(path, "cannot resolve the link", errno);
  return real.get();
}

// Refuses what a rename would destroy or fail on, and returns the name to rename to.
std::string checked_target(const std::string& path) {
  if (path.empty()) throw CannotWrite("the name of the output file is empty");
  const std::string name = name_of(path);
  if (name.empty() || name == "." || name == "..") throw CannotWrite(path + ": is a folder, expected a file name");
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT) cannot_write(path, "cannot be looked up", errno);
    return path;
  }
  if (S_ISDIR(status.st_mode)) throw CannotWrite(path + ": is a folder, expected a file name");
  if (!S_ISREG(status.st_mode)) throw CannotWrite(path + ": exists and is not a regular file");
  if (::access(path.c_str(), W_OK) != 0) cannot_write(path, "exists and cannot be replaced", errno);
  struct stat link {};
  if (::lstat(path.c_str(), &link) == 0 && S_ISLNK(link.st_mode)) return resolve_links(path);
  return path;
}

std::string descriptor_name(int fd) { return "/proc/self/fd/" + std::to_string(fd); }

// A file without a name, which the system frees however the process ends; -1 where there is no such thing, or no way to
// give it a name later.
int open_unnamed(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kNewFileMode);
  if (fd < 0 || ::access(descriptor_name(fd).c_str(), F_OK) == 0) return fd;
  ::close(fd);
  return -1;
}

}  // namespace

std::uint32_t add_to_crc(std::uint32_t crc, std::span<const std::byte> bytes) {
  if (bytes.empty()) return crc;  // zlib takes no bytes for a wish to begin
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string temporary_name(const std::string& target) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  const std::size_t slash = target.rfind('/');
  std::string name = slash == std::string::npos ? "" : target.substr(0, slash + 1);
  name += '.';
  name += name_of(target).substr(0, kLongestNameKept);
  name += '.';
  for (int i = 0; i < 6; ++i) name += kLetters[random() % kLetters.size()];
  return name + ".partial";
}

namespace {

// Creates a new file in the folder of `target`; says its name in `temporary` if it has one.
int open_temporary(const std::string& path, const std::string& target, std::string& temporary) {
  if (const int fd = open_unnamed(folder_of(target)); fd >= 0) return fd;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string name = temporary_name(target);
    const int fd = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
    if (fd >= 0) {
      temporary = name;
      return fd;
    }
    if (errno != EEXIST && errno != EINTR)
      cannot_write(path, "cannot create a file in '" + folder_of(target) + "'", errno);
  }
  throw CannotWrite(path + ": no free temporary name in '" + folder_of(target) + "'");
}

}  // namespace

// A folder that may be written but not read, or a file system without this operation,
// leaves that to the system; the file itself is complete.
void sync_folder(const std::string& path, const std::string& target) {
  const int fd = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  const int result = ::fsync(fd);
  const int error = errno;
  ::close(fd);
  if (result != 0 && error != EINVAL && error != ENOTSUP) cannot_write(path, "cannot flush the folder", error);
}

OutputDescriptor::OutputDescriptor(int fd, std::string path, std::uint64_t size)
    : fd_(fd), path_(std::move(path)), size_(size) {}

OutputDescriptor::OutputDescriptor(OutputDescriptor&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      path_(std::move(other.path_)),
      size_(other.size_),
      buffer_(std::move(other.buffer_)),
      checksum_(other.checksum_),
      keeps_overwritten_(other.keeps_overwritten_),
      overwritten_(std::move(other.overwritten_)),
      is_checked_(other.is_checked_) {}

OutputDescriptor::~OutputDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

void OutputDescriptor::fail(const char* what, int error) const { cannot_write(path_, what, error); }

void OutputDescriptor::write(std::span<const std::byte> bytes) {
  is_checked_ = false;
  if (bytes.size() > kBufferBytes - buffer_.size()) flush();
  if (bytes.size() >= kBufferBytes) {
    write_now(bytes);
  } else {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }
  size_ += bytes.size();
  if (checksum_) checksum_ = add_to_crc(*checksum_, bytes);
}

void OutputDescriptor::flush() {
  write_now(buffer_);
  buffer_.clear();
}

void OutputDescriptor::write_now(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (written == 0 || errno != EINTR) {
      fail("cannot write", written == 0 ? ENOSPC : errno);
    }
  }
}

void OutputDescriptor::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (offset > size_ || bytes.size() > size_ - offset) throw std::invalid_argument("overwrite past the end of a file");
  is_checked_ = false;
  if (checksum_) replace_in_checksum(offset, bytes);
  flush();
  if (keeps_overwritten_) save_overwritten(offset, bytes.size());
  pwrite_now(offset, bytes);
}

void OutputDescriptor::pwrite_now(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      offset += static_cast<std::uint64_t>(written);
    } else if (written == 0 || errno != EINTR) {
      fail("cannot write", written == 0 ? ENOSPC : errno);
    }
  }
}

void OutputDescriptor::read_back(std::uint64_t offset, std::span<std::byte> bytes) {
  flush();
  while (!bytes.empty()) {
    const ssize_t got = ::pread(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(got));
      offset += static_cast<std::uint64_t>(got);
    } else if (got == 0) {
      throw CannotWrite(path_ + ": holds less than was written to it");
    } else if (errno != EINTR) {
      fail("cannot read back", errno);
    }
  }
}

void OutputDescriptor::append(OutputDescriptor& source) {
  is_checked_ = false;
  source.flush();
  flush();
  std::uint64_t done = append_in_kernel(source);
  std::vector<std::byte> block(
      static_cast<std::size_t>(std::min<std::uint64_t>(4 * kBufferBytes, source.size_ - done)));
  while (done < source.size_) {
    const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), source.size_ - done));
    source.read_back(done, std::span(block).first(count));
    write_now(std::span(block).first(count));
    done += count;
  }
  if (checksum_) add_to_checksum(source);
  size_ += source.size_;
}

// The copy has the bytes that were written to the source, or the file is found out when it is verified.
void OutputDescriptor::add_to_checksum(const OutputDescriptor& source) {
  if (!source.checksum_) throw std::logic_error(path_ + ": a file with a checksum takes files with one only");
  checksum_ =
      static_cast<std::uint32_t>(::crc32_combine(*checksum_, *source.checksum_, static_cast<z_off_t>(source.size_)));
}

// A CRC is linear: bytes that change by a difference change it by the CRC of that difference, in front of as many zeros
// as there are bytes behind it.
void OutputDescriptor::replace_in_checksum(std::uint64_t offset, std::span<const std::byte> bytes) {
  std::vector<std::byte> before(bytes.size());
  read_back(offset, before);
  const std::uint32_t change = add_to_crc(0, before) ^ add_to_crc(0, bytes);
  const std::uint64_t behind = size_ - offset - bytes.size();
  *checksum_ ^= static_cast<std::uint32_t>(::crc32_combine(change, 0, static_cast<z_off_t>(behind)));
}

void OutputDescriptor::save_overwritten(std::uint64_t offset, std::uint64_t count) {
  const std::array<std::uint64_t, 2> place{offset, count};
  const auto head = std::as_bytes(std::span(place));
  overwritten_.insert(overwritten_.end(), head.begin(), head.end());
  overwritten_.resize(overwritten_.size() + static_cast<std::size_t>(count));
  read_back(offset, std::span(overwritten_).last(static_cast<std::size_t>(count)));
  const std::string name = overwritten_name(path_);
  const std::string unfinished = new_name(name);  // a process was killed as it wrote that
  const int fd = ::open(unfinished.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, kNewFileMode);
  if (fd < 0) cannot_write(unfinished, "cannot be created", errno);
  OutputDescriptor file(fd, unfinished);
  file.write(overwritten_);
  file.close();
  if (::rename(unfinished.c_str(), name.c_str()) != 0) cannot_write(name, "cannot be renamed into place", errno);
  sync_folder(path_, name);
}

void OutputDescriptor::restore_overwritten() {
  const std::string name = overwritten_name(path_);
  const int fd = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0 && errno == ENOENT) return forget_overwritten();
  if (fd < 0) cannot_write(name, "cannot be opened", errno);
  struct stat status {};
  OutputDescriptor file(fd, name);
  if (::fstat(fd, &status) != 0) cannot_write(name, "cannot be looked up", errno);
  std::vector<std::byte> saved(static_cast<std::size_t>(status.st_size));
  file.read_back(0, saved);
  std::vector<OverwrittenBytes> records = overwritten_in(saved, name);
  std::reverse(records.begin(), records.end());  // what was overwritten last is put back first
  for (const auto& [offset, bytes] : records) {
    if (offset < size_) pwrite_now(offset, bytes.first(std::min<std::uint64_t>(bytes.size(), size_ - offset)));
  }
  sync();
  forget_overwritten();
}

void OutputDescriptor::forget_overwritten() const {
  const std::string name = overwritten_name(path_);
  ::unlink(name.c_str());
  ::unlink(new_name(name).c_str());
}

void OutputDescriptor::verify() {
  if (!checksum_) return;
  if (crc_of_file(*this) != *checksum_) throw CannotWrite(path_ + ": holds other bytes than were written to it");
}

// Copies as far as the file system can do it by itself; returns how far. Errors are left for the plain copy to meet.
std::uint64_t OutputDescriptor::append_in_kernel(const OutputDescriptor& source) {
  off_t offset = 0;
  while (static_cast<std::uint64_t>(offset) < source.size_) {
    const std::size_t rest = static_cast<std::size_t>(source.size_ - static_cast<std::uint64_t>(offset));
    const ssize_t copied = ::copy_file_range(source.fd_, &offset, fd_, nullptr, rest, 0);
    if (copied <= 0 && !(copied < 0 && errno == EINTR)) break;
  }
  return static_cast<std::uint64_t>(offset);
}

void OutputDescriptor::copy_to(int descriptor, const std::string& name) {
  flush();
  const int copy = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  if (copy < 0) cannot_write(name, "cannot write", errno);
  OutputDescriptor other(copy, name);
  std::vector<std::byte> block(static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, size_)));
  for (std::uint64_t done = 0; done < size_; done += block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), size_ - done)));
    read_back(done, block);
    other.write_now(block);
  }
}

void OutputDescriptor::sync() {
  flush();
  if (::fsync(fd_) != 0) fail("cannot flush to the disk", errno);
}

void OutputDescriptor::cut_off() {
  flush();
  const auto end = static_cast<off_t>(size_);
  if (::ftruncate(fd_, end) != 0 || ::lseek(fd_, end, SEEK_SET) != end) fail("cannot be cut off", errno);
}

bool OutputDescriptor::try_lock() const { return isoweave::try_lock(fd_, path_); }

bool OutputDescriptor::link_as(const std::string& name) const {
  return ::linkat(AT_FDCWD, descriptor_name(fd_).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

void OutputDescriptor::check() {
  sync();
  struct stat status {};
  if (::fstat(fd_, &status) != 0) fail("cannot be looked up", errno);
  if (static_cast<std::uint64_t>(status.st_size) != size_) {
    throw CannotWrite(path_ + ": wrote " + std::to_string(size_) + " bytes, the disk holds " +
                      std::to_string(status.st_size));
  }
  verify();
  is_checked_ = true;
}

void OutputDescriptor::close() {
  if (!is_checked_) check();
  // Whatever close says, the descriptor is gone afterwards.
  if (::close(std::exchange(fd_, -1)) != 0) fail("cannot close", errno);
}

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), target_(checked_target(path)), file_(open_temporary(path_, target_, temporary_), path_) {}

AtomicFile::AtomicFile(const std::string& path, const PartFile& part)
    : path_(path), target_(checked_target(path)), temporary_(part.path), kept_(true), file_(open_part(part)) {}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty() && !kept_) ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  file_.check();
  if (temporary_.empty() || kept_) {
    const bool linked = link_file();
    if (!linked && kept_) return copy_into_place();
    if (!linked) cannot_write(path_, "cannot be given a name", errno);
  }
  kept_ = false;
  file_.close();
  if (!temporary_.empty() && ::rename(temporary_.c_str(), target_.c_str()) != 0) {
    cannot_write(path_, "cannot be renamed into place", errno);
  }
  temporary_.clear();
  sync_folder(path_, target_);
}

// Gives the file the target's name, or a temporary one beside it where the target is there: a name cannot take another
// file's place. False when a file system allows neither, as it does for a part file that lies elsewhere.
bool AtomicFile::link_file() {
  std::string name = target_;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (file_.link_as(name)) {
      temporary_ = name == target_ ? "" : std::move(name);
      return true;
    }
    if (errno != EEXIST) return false;
    name = temporary_name(target_);
  }
  throw CannotWrite(path_ + ": no free temporary name in '" + folder_of(target_) + "'");
}

void AtomicFile::copy_into_place() {
  AtomicFile copy(path_);
  OutputDescriptor part = open_part_again(temporary_, PartMark{file_.size(), *file_.checksum()});
  part.keep_checksum(*file_.checksum());
  copy.file_.keep_checksum(0);
  copy.append(part);
  copy.commit();
}

bool try_lock(int fd, const std::string& path) {
  while (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return false;
    if (errno != EINTR) cannot_write(path, "cannot be locked against other processes", errno);
  }
  return true;
}

namespace {

OutputDescriptor create_part(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
  if (fd < 0 && errno == EEXIST) {
    throw CannotWrite(path + ": is there already: resume the unfinished run that it belongs to, or remove it");
  }
  if (fd < 0) cannot_write(path, "cannot be created", errno);
  OutputDescriptor file(fd, path);
  file.forget_overwritten();  // of a part that went before
  return file;
}

}  // namespace

OutputDescriptor open_part(const PartFile& part) {
  OutputDescriptor file = part.mark ? open_part_again(part.path, *part.mark) : create_part(part.path);
  if (!file.try_lock()) throw CannotWrite(part.path + ": another process is writing to it");
  file.keep_checksum(part.mark ? part.mark->checksum : 0);
  file.keep_overwritten();
  if (!part.mark) return file;
  file.restore_overwritten();
  if (crc_of_file(file) != part.mark->checksum) bad_part(part.path, *part.mark, "others: its checksum does not fit");
  file.cut_off();  // of what came after the state was saved
  return file;
}

void remove_part(const std::string& path) {
  ::unlink(path.c_str());
  const std::string overwritten = overwritten_name(path);
  ::unlink(overwritten.c_str());
  ::unlink(new_name(overwritten).c_str());
}

int open_scratch(const std::string& path) { return open_scratch_in(folder_of(checked_target(path)), path); }

int open_scratch_in(const std::string& folder, const std::string& path) {
  std::string temporary;
  const int fd = open_temporary(path, folder + "/scratch", temporary);
  if (!temporary.empty()) ::unlink(temporary.c_str());
  return fd;
}

}  // namespace isoweave
