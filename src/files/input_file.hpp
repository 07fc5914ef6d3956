// A file opened for reading, whatever holds its bytes, and the one way a reader says that an input is bad.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace isoweave {

// Throws BadInput "PATH: expected EXPECTED, found FOUND".
[[noreturn]] void bad_input(std::string_view path, std::string_view expected, std::string_view found);

// Throws BadInput "PATH: MESSAGE".
[[noreturn]] void bad_input(std::string_view path, std::string_view message);

class InputFile {
 public:
  virtual ~InputFile() = default;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // The name that messages use.
  const std::string& path() const { return path_; }

  // The most bytes that the file can have. That is their number, except for a packed file whose end has not been read
  // yet.
  std::uint64_t size() const { return size_; }

  // The number of bytes. In a packed file it may take reading all of them.
  virtual std::uint64_t exact_size() const { return size_; }

  // The size for messages: "120", or "at most 120 once inflated".
  std::string size_text() const;

  // Whether bytes can be read in any order at the same cost. Other files should be read forward.
  virtual bool jumps() const { return true; }

  // Reads up to out.size() bytes from `offset` on; fewer only at the end of the file.
  virtual std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) const = 0;

  // Tells the system that nobody will read these bytes again soon. Changes nothing but speed.
  virtual void forget(std::uint64_t, std::uint64_t) const {}

  // Must be called when everything wanted has been read, up to `offset`. A packed file checks its sum if its end is
  // near.
  virtual void check_end(std::uint64_t) const {}

  // The name by which a library can open the file itself. Only for a file that jumps, and while it is open.
  virtual std::string system_path() const { return path_; }

  // The first bytes of the file, at most `limit`, as text.
  std::string head(std::size_t limit) const;

 protected:
  InputFile(std::string path, std::uint64_t size) : path_(std::move(path)), size_(size) {}
  virtual bool knows_size() const { return true; }
  void set_size(std::uint64_t size) const { size_ = size; }

 private:
  std::string path_;
  mutable std::uint64_t size_;
};

using FilePtr = std::shared_ptr<const InputFile>;

// A file that is read by a descriptor, which is closed with it.
class DescriptorFile final : public InputFile {
 public:
  // `unnamed`: `path` is only what messages call it.
  DescriptorFile(int descriptor, std::string path, std::uint64_t size, bool unnamed);
  ~DescriptorFile() override;

  std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) const override;
  void forget(std::uint64_t offset, std::uint64_t bytes) const override;
  std::string system_path() const override;

 private:
  int descriptor_;
  bool unnamed_;
};

// The kind of file that messages say was expected, where a file is empty or none.
inline constexpr std::string_view kVolumeFile = "a volume file";

// Throws BadInput when the path is missing, not a regular file, not readable or empty.
FilePtr open_file(const std::string& path, std::string_view wanted = kVolumeFile);

// The path of `name` as written in the header `header_path`: relative to the header's folder.
std::string beside(const std::string& header_path, const std::string& name);

}  // namespace isoweave
