// A file without a name that holds parts which wait. The system frees it however the process ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/atomic_file.hpp"

namespace isoweave {

class PartScratch {
 public:
  // The bytes of a part in the file.
  struct Place {
    std::uint64_t first = 0, count = 0;
  };

  // Makes the file in a folder. Throws CannotWrite, as all members do.
  explicit PartScratch(const std::string& folder) : file_(open_scratch_in(folder, folder), folder) {}

  Place put(std::span<const std::byte> bytes);

  // Takes bytes out: their room on the disk is free then.
  std::vector<std::byte> take(const Place& place);

 private:
  OutputDescriptor file_;
};

}  // namespace isoweave
