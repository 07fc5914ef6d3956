// The input that a user names as a volume or a mesh: a file, or a pipe, whose content is kept in a file without a name.
#pragma once

#include <string>
#include <string_view>

#include "files/input_file.hpp"

namespace isoweave {

inline constexpr const char* kStandardInput = "/dev/stdin";

// Opens a regular file, or everything that comes out of a pipe or socket. A pipe can be read once, so opening it again
// while its content is still held gives the same content. Throws what open_file throws; CannotWrite when there is no
// room.
FilePtr open_input_file(const std::string& path, std::string_view wanted = kVolumeFile);

// A file that can be read in any order: the file itself, or the content of a packed one, as a file without a name.
FilePtr jumping_file(const FilePtr& file);

// A name in some folder for as long as this lives, for a library that follows links to files: what has no name gets
// one.
class FileName {
 public:
  // Throws BadInput where the file system cannot do that.
  explicit FileName(const InputFile& file);
  ~FileName();
  FileName(const FileName&) = delete;
  FileName& operator=(const FileName&) = delete;

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool given_;
};

}  // namespace isoweave
