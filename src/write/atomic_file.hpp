// An output file that appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace isoweave {

// Writes to ".NAME.XXXXXX.partial" in the folder of `path`; commit() makes it `path`. Without a commit nothing is
// left behind. All members throw CannotWrite "PATH: ..." with the reason of the system.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Appends. Nothing is collected: large pieces are faster than many small ones.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  // Overwrites bytes that were written before, for counts known only at the end.
  void rewrite(std::uint64_t offset, std::span<const std::byte> bytes);

  // Bytes written so far.
  std::uint64_t size() const { return size_; }

  // Brings the data to disk and renames.
  void commit();

 private:
  void create_partial();
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  [[noreturn]] void fail(std::string_view action) const;

  std::string path_;
  std::string partial_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace isoweave
