// Facts of files: the kind of a file by its name or descriptor, and the facts by which a changed file is recognised.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace isoweave::system {

struct FileFacts {
  std::uint64_t bytes = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  // of the last change, since 1970
};

// The facts of a regular file. Nothing for other names.
std::optional<FileFacts> facts_of_file(const std::string& path);

struct FileStatus {
  enum class Kind : std::uint8_t { kRegular, kFolder, kPipe, kOther };  // a socket is a pipe

  Kind kind = Kind::kOther;
  std::uint64_t bytes = 0;
  std::uint64_t names = 0;             // of the same file
  std::uint64_t device = 0, file = 0;  // no two files have both in common

  bool same_file(const FileStatus& other) const { return device == other.device && file == other.file; }
};

// The status of an open file, or of the file that a name leads to. Nothing where the system does not tell: errno says
// why.
std::optional<FileStatus> status_of(int descriptor);
std::optional<FileStatus> status_of(const std::string& path);

// The name that symbolic links lead to, whether or not there is a file of that name.
std::string follow_links(const std::string& path);

// Whether a file may be written; false on failure, with the reason in errno.
bool may_write(const std::string& path);

// Names of files that a pattern of the shell stands for, in any order; nothing where a folder cannot be listed.
std::optional<std::vector<std::string>> names_like(const std::string& pattern);

}  // namespace isoweave::system
