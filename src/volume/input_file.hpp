// A regular file opened for reading, and the one way a reader says that an input is bad.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace isoweave {

// Throws BadInput "PATH: expected EXPECTED, found FOUND".
[[noreturn]] void bad_input(std::string_view path, std::string_view expected, std::string_view found);

// Throws BadInput "PATH: MESSAGE".
[[noreturn]] void bad_input(std::string_view path, std::string_view message);

class InputFile {
 public:
  // Throws BadInput when the path is missing, not a regular file, not readable or empty.
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  // Reads up to out.size() bytes from `offset` on; fewer only at the end of the file.
  std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) const;

  // Tells the system that nobody will read these bytes again soon. Changes nothing but speed.
  void forget(std::uint64_t offset, std::uint64_t bytes) const;

  // The first bytes of the file, at most `limit`, as text.
  std::string head(std::size_t limit) const;

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

std::shared_ptr<InputFile> open_file(const std::string& path);

// The path of `name` as written in the header `header_path`: relative to the header's folder.
std::string beside(const std::string& header_path, const std::string& name);

}  // namespace isoweave
