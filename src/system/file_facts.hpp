// Facts of a file by which a changed one is told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace isoweave::system {

struct FileFacts {
  std::uint64_t bytes = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  // of the last change, since 1970
};

// Nothing for a name of no regular file.
std::optional<FileFacts> facts_of_file(const std::string& path);

}  // namespace isoweave::system
