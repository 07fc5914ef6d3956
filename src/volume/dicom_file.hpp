// One DICOM file of one slice: what its header says, and its samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

// Values as the file has them; what is not there is 0 or empty.
struct DicomSlice {
  std::string path;
  std::string syntax;  // Transfer Syntax UID
  std::string series;  // Series Instance UID; programs that hide patients may drop it
  std::string description;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  int bits = 0;    // allocated
  int stored = 0;  // of them used
  int high = 0;    // the uppermost of those
  bool is_signed = false;
  int samples = 1;
  bool enhanced = false;   // geometry is kept per frame
  bool has_table = false;  // from samples to values
  std::string photometric;
  std::string frames;
  std::string position;  // the texts of the header, numbers between backslashes
  std::string orientation;
  std::string pixel_spacing;  // between rows, then between columns
  std::string slice_spacing;
  std::string thickness;
  std::string slope;
  std::string intercept;

  // Where the samples lie: one range of the file, or, where they are packed, one for each fragment.
  using Range = std::pair<std::uint64_t, std::uint64_t>;  // first byte, number of bytes
  std::vector<Range> pixels;
  bool packed = false;

  std::uint64_t pixel_bytes() const;
};

// Nothing for a DICOM file that holds no image. Throws BadInput when the file is damaged, or of a transfer syntax that
// is not read. Nothing is allocated that an element merely claims.
std::optional<DicomSlice> read_dicom_header(const std::string& path);

// The samples, in the machine's byte order. Throws BadInput unless they are `bytes` of `type`.
std::vector<std::byte> decode_dicom(const DicomSlice& slice, SampleType type, std::size_t bytes);

// Unpack samples after check_frame_header. Throw BadInput when they do not decode to `bytes`. The first takes JPEG-LS too.
std::vector<std::byte> unpack_jpeg(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes);
std::vector<std::byte> unpack_jpeg2000(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes);

}  // namespace isoweave
