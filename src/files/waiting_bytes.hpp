// Bytes that wait in a file without a name, which many growing arrays share: thousands of them need one descriptor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/atomic_file.hpp"

namespace isoweave {

// The file. It is made when the first bytes come. Several threads may call it at the same time.
class WaitingFile {
 public:
  // folder: where the file lies. path: the name in messages.
  WaitingFile(std::string folder, std::string path) : folder_(std::move(folder)), path_(std::move(path)) {}

  // Both members throw CannotWrite. append() returns where the bytes are.
  std::uint64_t append(std::span<const std::byte> bytes);
  void read_back(std::uint64_t first, std::span<std::byte> bytes);

  // Gives the room of bytes back to the system.
  void free(std::uint64_t first, std::uint64_t count);

  std::uint64_t size() const { return file_ ? file_->size() : 0; }

 private:
  std::string folder_, path_;
  std::mutex mutex_;
  std::optional<OutputDescriptor> file_;
};

// A growing array of bytes: its last ones are in memory, the others in the file.
class WaitingBytes {
 public:
  // The file must outlive the array.
  explicit WaitingBytes(WaitingFile& file) : file_(&file) {}
  ~WaitingBytes();
  WaitingBytes(const WaitingBytes&) = delete;
  WaitingBytes& operator=(const WaitingBytes&) = delete;

  void write(std::span<const std::byte> bytes);
  void read_back(std::uint64_t first, std::span<std::byte> bytes) const;

 private:
  static constexpr std::uint64_t kBlock = std::uint64_t{1} << 14;

  WaitingFile* file_;
  std::vector<std::uint64_t> blocks_;  // where each is in the file
  std::vector<std::byte> last_;        // less than a block
};

}  // namespace isoweave
