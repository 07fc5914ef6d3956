// An array of NumPy: in a file of its own, or one of several in an archive.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "volume/formats/chunked/array_axes.hpp"
#include "volume/half_floats.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

struct NpyHeader {
  std::string type;            // "<i2": the byte order, the kind and the bytes of a number
  bool first_fastest = false;  // the order of Fortran
  std::vector<ArrayAxis> axes;
  std::uint64_t data = 0;  // byte of the first sample
};

// Throws BadInput for what is no header, and for arrays of structures.
NpyHeader read_npy_header(const FilePtr& file);

// The type of an array; nothing for types that are not read.
std::optional<StoredType> npy_type(const NpyHeader& header);

OpenedVolume open_npy_array(const FilePtr& file, const NpyHeader& header, const OpenOptions& options);

}  // namespace isoweave
