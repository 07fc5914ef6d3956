// The bytes of a DICOM file, wherever in it they are wanted.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "volume/formats/formats.hpp"

namespace isoweave {

class DicomBytes {
 public:
  virtual ~DicomBytes() = default;

  virtual const std::string& path() const = 0;
  virtual std::uint64_t size() const = 0;

  // Reads up to out.size() bytes from `offset` on; fewer only at the end.
  virtual std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) = 0;
};

using DicomBytesPtr = std::shared_ptr<DicomBytes>;

DicomBytesPtr plain_bytes(FilePtr file);

// The bytes of a file that is deflated from byte `begin` on, as if it were not. Holds little; going back by more than
// that means to inflate from the beginning. Inflates everything once to find the size.
DicomBytesPtr inflated_bytes(FilePtr file, std::uint64_t begin);

}  // namespace isoweave
