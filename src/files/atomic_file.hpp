// Output files that are complete or absent, and scratch files that never outlive their owner.
//
// All failures are CannotWrite with one line: the path as the user gave it, what failed, the system's reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/crc32.hpp"

namespace isoweave {

// An open file descriptor with a write buffer; closes it when destroyed.
class OutputDescriptor {
 public:
  // `path` is the name used in messages. Writing continues at byte `size`, where the file must end and stand.
  OutputDescriptor(int fd, std::string path, std::uint64_t size = 0);
  ~OutputDescriptor();
  OutputDescriptor(const OutputDescriptor&) = delete;
  OutputDescriptor& operator=(const OutputDescriptor&) = delete;
  OutputDescriptor(OutputDescriptor&& other) noexcept;

  void write(std::span<const std::byte> bytes);
  void flush();

  // Both members work on bytes written before.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  void read_back(std::uint64_t offset, std::span<std::byte> bytes);

  // Gives the room of bytes written before back to the system, where it can do that. Nobody reads them any more.
  void free(std::uint64_t first, std::uint64_t count) const;

  // Appends everything written to `source`.
  void append(OutputDescriptor& source);

  // Writes the whole file to another descriptor, which stays open. `name` stands for that descriptor in messages.
  void copy_to(int descriptor, const std::string& name);

  // Makes the bytes written so far durable.
  void sync();

  // Keeps a CRC-32 of the whole file from now on. It begins as that of the bytes in the file.
  void keep_checksum(std::uint32_t so_far) { checksum_ = so_far; }
  std::optional<std::uint32_t> checksum() const { return checksum_; }

  // Keeps overwritten bytes from now on, in a file beside this one, so that open_part finds the bytes that a state was
  // saved with, however the process ends.
  void keep_overwritten() { keeps_overwritten_ = true; }

  // Puts overwritten bytes back, as far as the file goes, and forgets them.
  void restore_overwritten();
  void forget_overwritten() const;

  // Reads the file from its beginning, where a checksum is kept. Throws CannotWrite when the file holds other bytes
  // than were written.
  void verify();

  // Removes the bytes of the file behind size().
  void cut_off();

  // Locks the file, as try_lock() below does.
  bool try_lock() const;

  // Gives a name to a file without one. Returns false, with errno set, when that cannot be done.
  bool link_as(const std::string& name) const;

  // Flushes, makes the data durable, and compares the size on disk and the checksum, if one is kept, with what was
  // written.
  void check();

  // Closes the file. Checks it first, unless that has been done.
  void close();

  std::uint64_t size() const { return size_; }

 private:
  void write_now(std::span<const std::byte> bytes);
  void add_to_checksum(const OutputDescriptor& source);
  void replace_in_checksum(std::uint64_t offset, std::span<const std::byte> bytes);
  void save_overwritten(std::uint64_t offset, std::uint64_t count);
  void pwrite_now(std::uint64_t offset, std::span<const std::byte> bytes);
  [[noreturn]] void fail(const char* what, int error) const;

  int fd_;
  std::string path_;
  std::uint64_t size_ = 0;
  std::vector<std::byte> buffer_;
  std::optional<std::uint32_t> checksum_;  // of all size_ bytes
  bool keeps_overwritten_ = false;
  std::vector<std::byte> overwritten_;  // as in the file beside: offset, count, bytes; and again
  bool is_checked_ = false;             // nothing was written since
};

// The mark of a part file: its size and checksum at a state.
struct PartMark {
  std::uint64_t size = 0;
  std::uint32_t checksum = 0;  // of so many bytes
};

// An unfinished file under a name of its own, to be continued by another process.
struct PartFile {
  std::string path;
  std::optional<PartMark> mark;  // to go on from; none: there is no such file yet
};

// A file that appears under its name only on commit(). Until then it lies in the same folder without a name, and is
// gone however the process ends. Where the file system cannot do that it is `.NAME.XXXXXX.partial`, which the
// destructor removes. A part file stays instead. A file that had the name before stays untouched until commit().
// Opening fails at once when the name is empty, a folder or not a regular file, or when the folder is missing or
// read-only.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  AtomicFile(const std::string& path, const PartFile& part);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  OutputDescriptor& descriptor() { return file_; }
  void write(std::span<const std::byte> bytes) { file_.write(bytes); }

  // Replaces bytes written before, for counts in a header.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes) { file_.overwrite(offset, bytes); }
  void read_back(std::uint64_t offset, std::span<std::byte> bytes) { file_.read_back(offset, bytes); }
  void append(OutputDescriptor& source) { file_.append(source); }
  void sync() { file_.sync(); }

  // Bytes written so far.
  std::uint64_t size() const { return file_.size(); }

  // Completes the file: flush, fsync, check of the size, its name, fsync of the folder. A part file stays beside it
  // under the name of the part.
  void commit();

 private:
  bool link_file();
  void copy_into_place();

  std::string path_;
  std::string target_;     // path_ with symbolic links resolved: a link stays a link
  std::string temporary_;  // set by open_temporary; empty while the file has no name, and once renamed
  bool kept_ = false;      // a part file
  OutputDescriptor file_;
};

// Creates a part file, or opens one and cuts it off at its mark. It keeps a checksum. Throws CannotWrite when the part
// to be created is there already, or another process has the part to be opened open; BadInput when that part is
// missing, shorter, or holds other bytes.
OutputDescriptor open_part(const PartFile& part);

// Locks an open file against all others that lock it, in this process, too. The system releases the lock when the
// descriptor is closed, however the process ends. Returns false when another holder has the lock; throws CannotWrite
// where there are no locks.
bool try_lock(int fd, const std::string& path);

// Removes a part file that is no longer needed, and the files kept beside it.
void remove_part(const std::string& path);

// Opens a scratch file beside `path`, already without a name: the system frees it however the process ends.
int open_scratch(const std::string& path);

// Opens a scratch file in a folder; `path` is the name used in messages.
int open_scratch_in(const std::string& folder, const std::string& path);

// The folder that `path` lies in.
std::string folder_of(const std::string& path);

// A name beside `target` that tells its purpose, with random letters.
std::string temporary_name(const std::string& target);

// Makes a rename to `target` durable; `path` is the name used in messages.
void sync_folder(const std::string& path, const std::string& target);

}  // namespace isoweave
