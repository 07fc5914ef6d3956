// Output files that are complete or absent, and scratch files that never outlive their owner.
//
// All failures are CannotWrite with one line: the path as the user gave it, what failed, the system's reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace isoweave {

// An open file descriptor with a write buffer; closes it when destroyed.
class OutputDescriptor {
 public:
  // `path` is the name used in messages.
  OutputDescriptor(int fd, std::string path);
  ~OutputDescriptor();
  OutputDescriptor(const OutputDescriptor&) = delete;
  OutputDescriptor& operator=(const OutputDescriptor&) = delete;

  void write(std::span<const std::byte> bytes);
  void flush();

  // Both work on bytes written before.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  void read_back(std::uint64_t offset, std::span<std::byte> bytes);

  // Appends all that was written to `source`.
  void append(OutputDescriptor& source);

  // Flushes, makes the data durable, compares the size on disk with what was written, and closes.
  void close();

  std::uint64_t size() const { return size_; }

 private:
  void write_now(std::span<const std::byte> bytes);
  std::uint64_t append_in_kernel(const OutputDescriptor& source);
  [[noreturn]] void fail(const char* what, int error) const;

  int fd_;
  std::string path_;
  std::uint64_t size_ = 0;
  std::vector<std::byte> buffer_;
};

// A file that appears under its name only on commit(): until then it is `.NAME.XXXXXX.partial` in the same folder,
// which the destructor removes. A file that had the name before stays untouched until then. Opening fails at once
// when the name is empty, a folder or not a regular file, or when the folder is missing or read-only.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes) { file_.write(bytes); }

  // Replaces bytes written before, for counts in a header.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes) { file_.overwrite(offset, bytes); }
  void read_back(std::uint64_t offset, std::span<std::byte> bytes) { file_.read_back(offset, bytes); }
  void append(OutputDescriptor& source) { file_.append(source); }

  // Bytes written so far.
  std::uint64_t size() const { return file_.size(); }

  // Completes the file: flush, fsync, check of the size, rename, fsync of the folder.
  void commit();

 private:
  std::string path_;
  std::string target_;     // path_ with symbolic links resolved: a link stays a link
  std::string temporary_;  // set by open_temporary; empty once renamed
  OutputDescriptor file_;
};

// Opens a scratch file beside `path`, already without a name: the system frees it however the process ends.
int open_scratch(const std::string& path);

}  // namespace isoweave
