// The slices of a DICOM file, one or one for each frame: what its header says of them, and their samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/volume.hpp"
#include "volume/formats/dicom/dicom_elements.hpp"
#include "volume/formats/dicom/dicom_moments.hpp"
#include "volume/formats/dicom/dicom_segments.hpp"

namespace isoweave {

// Values as the file has them; what is not there is 0 or empty.
struct DicomSlice {
  std::string file;
  std::string path;    // of the file, for messages; with the number of the frame where there are several
  std::string syntax;  // Transfer Syntax UID
  std::string media;   // SOP class, by the first group of the file or by the image
  std::string image;   // SOP Instance UID
  std::string series;  // Series Instance UID; programs that hide patients may drop it
  std::string description;
  std::string image_type;  // words between backslashes
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  int bits = 0;    // allocated
  int stored = 0;  // of them used
  int high = 0;    // the uppermost of those
  bool is_signed = false;
  int samples = 1;
  bool has_table = false;  // from samples to values
  std::string photometric;
  std::string frames;
  double offset = 0;     // from the position along the normal of the slice, in mm
  std::string position;  // the texts of the header, numbers between backslashes
  std::string orientation;
  std::string pixel_spacing;  // between rows, then between columns
  std::string slice_spacing;
  std::string thickness;
  std::string slope;
  std::string intercept;
  std::string instance;  // Instance Number
  DicomMoments moments;
  std::size_t frame = 0;  // of the file, from 0

  bool has_unit = true;   // whether the pixel spacing is in mm; else it is not said
  std::string placed_by;  // where a frame's place is not its own: what it is taken from, for a note

  // The places of the samples: one range of the file, or, where samples are packed, one range for each fragment. Places
  // in a deflated file are counted as inflated.
  std::vector<DicomRange> pixels;
  bool packed = false;
  int first_bit = 0;  // of the first byte, where samples are plain and have 1 bit: frames follow without a gap

  // Where the image is a segmentation: its segments, and the one that the frame is of, 0 if it is of all.
  std::shared_ptr<const DicomSegments> segmentation;
  std::uint32_t segment = 0;

  std::uint64_t data_set = 0;         // its first byte
  std::shared_ptr<DicomBytes> bytes;  // the open file, where it holds several frames

  std::uint64_t pixel_bytes() const;  // as they are stored
  std::uint64_t plain_bits() const;   // of the samples where they are not packed
  std::uint64_t plain_bytes() const;  // that these lie in

  // The path but for the folders above that of the file, for messages that name two of them.
  std::string name() const;
};

// The slices of a file, in the order of its frames; none for a DICOM file that holds no image. Throws BadInput when the
// file is damaged, of a transfer syntax that is not read, or holds frames that are no slices.
std::vector<DicomSlice> read_dicom_header(const std::string& path);

// Whether a DICOM file is the index of an export (DICOMDIR), which names other files and holds no image.
bool is_dicomdir(const std::string& path);

// Whether samples have bits above those that the header says are stored, and not just as many signs. They are cleared
// by decode_dicom.
bool has_bits_above(const DicomSlice& slice, SampleType type, std::size_t bytes);

// Whether two slices are one frame of one image, and their files hold the same bytes as samples.
bool is_copy(const DicomSlice& a, const DicomSlice& b);

// The samples, in the machine's byte order; those of 1 bit as bytes, 0 or 1. Throws BadInput unless they are `bytes` of
// `type`.
std::vector<std::byte> decode_dicom(const DicomSlice& slice, SampleType type, std::size_t bytes);

// Unpack samples after check_frame_header. Throw BadInput when they do not decode to `bytes`.
std::vector<std::byte> unpack_jpeg(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes);
std::vector<std::byte> unpack_jpegls(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes);
std::vector<std::byte> unpack_jpeg2000(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes);

}  // namespace isoweave
