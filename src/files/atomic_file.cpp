#include "files/atomic_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "isoweave/error.hpp"
#include "parallel/size.hpp"
#include "system/descriptor.hpp"
#include "system/durable_file.hpp"
#include "system/file_facts.hpp"

namespace isoweave {
namespace {

using system::FileStatus;
using system::Opening;

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
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

// The records for the file `name`: offset, count, bytes.
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

// The CRC of everything written to a file.
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

// The name of a file that is to take the place of another one.
std::string new_name(const std::string& path) { return path + ".new"; }

// Replaces a part by a copy of itself. A part that has become the mesh already, under a second name, must not be
// written to.
void own_part(const std::string& path, std::uint64_t size) {
  const int from = system::open_descriptor(path, Opening::kWrite);
  if (from < 0) cannot_write(path, "cannot be opened", errno);
  OutputDescriptor part(from, path, size);
  AtomicFile copy(path);
  copy.append(part);
  copy.commit();
}

OutputDescriptor open_part_again(const std::string& path, const PartMark& mark) {
  const int fd = system::open_descriptor(path, Opening::kWrite);
  if (fd < 0) bad_part(path, mark, std::generic_category().message(errno));
  OutputDescriptor file(fd, path, mark.size);
  const std::optional<FileStatus> status = system::status_of(fd);
  if (!status) cannot_write(path, "cannot be looked up", errno);
  if (status->bytes < mark.size) bad_part(path, mark, std::to_string(status->bytes) + " bytes");
  if (status->names == 1) return file;
  own_part(path, status->bytes);
  return open_part_again(path, mark);
}

std::string name_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

void require_replaceable(const std::string& path, FileStatus::Kind kind) {
  if (kind == FileStatus::Kind::kFolder) throw CannotWrite(path + ": is a folder, expected a file name");
  if (kind != FileStatus::Kind::kRegular) throw CannotWrite(path + ": exists and is not a regular file");
  if (!system::may_write(path)) cannot_write(path, "exists and cannot be replaced", errno);
}

// Refuses targets that a rename would destroy or fail on, and returns the name to rename to.
std::string checked_target(const std::string& path) {
  if (path.empty()) throw CannotWrite("the name of the output file is empty");
  const std::string name = name_of(path);
  if (name.empty() || name == "." || name == "..") throw CannotWrite(path + ": is a folder, expected a file name");
  const std::optional<FileStatus> status = system::status_of(path);
  if (!status && errno != ENOENT) cannot_write(path, "cannot be looked up", errno);
  if (status) require_replaceable(path, status->kind);
  return system::follow_links(path);
}

}  // namespace

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
  if (const int fd = system::create_unnamed(folder_of(target)); fd >= 0) return fd;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string name = temporary_name(target);
    const int fd = system::open_descriptor(name, Opening::kCreateNew);
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

void sync_folder(const std::string& path, const std::string& target) {
  if (!system::sync_names(folder_of(target))) cannot_write(path, "cannot flush the folder", errno);
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
  if (fd_ >= 0) system::close_descriptor(fd_);
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
  if (!system::write_all(fd_, bytes)) fail("cannot write", errno);
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
  if (!system::write_all_at(fd_, offset, bytes)) fail("cannot write", errno);
}

void OutputDescriptor::read_back(std::uint64_t offset, std::span<std::byte> bytes) {
  flush();
  while (!bytes.empty()) {
    const std::int64_t got = system::read_at(fd_, offset, bytes);
    if (got < 0) fail("cannot read back", errno);
    if (got == 0) throw CannotWrite(path_ + ": holds less than was written to it");
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
}

void OutputDescriptor::free(std::uint64_t first, std::uint64_t count) const { system::free_bytes(fd_, first, count); }

void OutputDescriptor::append(OutputDescriptor& source) {
  is_checked_ = false;
  source.flush();
  flush();
  std::uint64_t done = system::copy_within_system(source.fd_, fd_, source.size_);  // its errors are left to the loop
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

// Adds the checksum of bytes copied from `source`. If the copy differs from what was written to the source, verify()
// finds out.
void OutputDescriptor::add_to_checksum(const OutputDescriptor& source) {
  if (!source.checksum_) throw std::logic_error(path_ + ": a file with a checksum takes files with one only");
  checksum_ = join_crcs(*checksum_, *source.checksum_, source.size_);
}

// A CRC is linear: bytes that change by a difference change it by the CRC of that difference, in front of as many zeros
// as there are bytes behind it.
void OutputDescriptor::replace_in_checksum(std::uint64_t offset, std::span<const std::byte> bytes) {
  std::vector<std::byte> before(bytes.size());
  read_back(offset, before);
  const std::uint32_t change = add_to_crc(0, before) ^ add_to_crc(0, bytes);
  const std::uint64_t behind = size_ - offset - bytes.size();
  *checksum_ ^= join_crcs(change, 0, behind);
}

void OutputDescriptor::save_overwritten(std::uint64_t offset, std::uint64_t count) {
  const std::array<std::uint64_t, 2> place{offset, count};
  const auto head = std::as_bytes(std::span(place));
  overwritten_.insert(overwritten_.end(), head.begin(), head.end());
  overwritten_.resize(to_size(overwritten_.size() + count));
  read_back(offset, std::span(overwritten_).last(static_cast<std::size_t>(count)));
  const std::string name = overwritten_name(path_);
  const std::string unfinished = new_name(name);  // a process was killed as it wrote that
  const int fd = system::open_descriptor(unfinished, Opening::kCreateEmpty);
  if (fd < 0) cannot_write(unfinished, "cannot be created", errno);
  OutputDescriptor file(fd, unfinished);
  file.write(overwritten_);
  file.close();
  if (!system::rename(unfinished, name)) cannot_write(name, "cannot be renamed into place", errno);
  sync_folder(path_, name);
}

void OutputDescriptor::restore_overwritten() {
  const std::string name = overwritten_name(path_);
  const int fd = system::open_descriptor(name, Opening::kRead);
  if (fd < 0 && errno == ENOENT) return forget_overwritten();
  if (fd < 0) cannot_write(name, "cannot be opened", errno);
  OutputDescriptor file(fd, name);
  const std::optional<FileStatus> status = system::status_of(fd);
  if (!status) cannot_write(name, "cannot be looked up", errno);
  std::vector<std::byte> saved(to_size(status->bytes));
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
  system::remove_name(name);
  system::remove_name(new_name(name));
}

void OutputDescriptor::verify() {
  if (!checksum_) return;
  if (crc_of_file(*this) != *checksum_) throw CannotWrite(path_ + ": holds other bytes than were written to it");
}

void OutputDescriptor::copy_to(int descriptor, const std::string& name) {
  flush();
  const int copy = system::duplicate(descriptor);
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
  if (!system::sync_file(fd_)) fail("cannot flush to the disk", errno);
}

void OutputDescriptor::cut_off() {
  flush();
  if (!system::cut_off(fd_, size_)) fail("cannot be cut off", errno);
}

bool OutputDescriptor::try_lock() const { return isoweave::try_lock(fd_, path_); }

bool OutputDescriptor::link_as(const std::string& name) const { return system::give_name(fd_, name); }

void OutputDescriptor::check() {
  sync();
  const std::optional<FileStatus> status = system::status_of(fd_);
  if (!status) fail("cannot be looked up", errno);
  if (status->bytes != size_) {
    throw CannotWrite(path_ + ": wrote " + std::to_string(size_) + " bytes, the disk holds " +
                      std::to_string(status->bytes));
  }
  verify();
  is_checked_ = true;
}

void OutputDescriptor::close() {
  if (!is_checked_) check();
  // Whatever close says, the descriptor is gone afterwards.
  if (!system::close_descriptor(std::exchange(fd_, -1))) fail("cannot close", errno);
}

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), target_(checked_target(path)), file_(open_temporary(path_, target_, temporary_), path_) {}

namespace {

// The target of a part, which lies elsewhere: that a file can be made beside the target is found now, and not when the
// part is complete.
std::string target_of_part(const std::string& path) {
  const AtomicFile other(path);
  return checked_target(path);
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path, const PartFile& part)
    : path_(path), target_(target_of_part(path)), temporary_(part.path), kept_(true), file_(open_part(part)) {}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty() && !kept_) system::remove_name(temporary_);
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
  if (!temporary_.empty() && !system::rename(temporary_, target_)) {
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
  const std::optional<bool> locked = system::try_lock(fd);
  if (!locked) cannot_write(path, "cannot be locked against other processes", errno);
  return *locked;
}

namespace {

OutputDescriptor create_part(const std::string& path) {
  const int fd = system::open_descriptor(path, Opening::kCreateNew);
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
  system::remove_name(path);
  const std::string overwritten = overwritten_name(path);
  system::remove_name(overwritten);
  system::remove_name(new_name(overwritten));
}

int open_scratch(const std::string& path) { return open_scratch_in(folder_of(checked_target(path)), path); }

int open_scratch_in(const std::string& folder, const std::string& path) {
  std::string temporary;
  const int fd = open_temporary(path, folder + "/scratch", temporary);
  if (!temporary.empty()) system::remove_name(temporary);
  return fd;
}

}  // namespace isoweave
