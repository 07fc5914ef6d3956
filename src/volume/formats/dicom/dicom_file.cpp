#include "volume/formats/dicom/dicom_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "parallel/size.hpp"
#include "volume/formats/dicom/dicom_bare.hpp"
#include "volume/formats/dicom/dicom_frames.hpp"
#include "volume/formats/dicom/dicom_packed.hpp"
#include "volume/formats/formats.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kDirectory = "1.2.840.10008.1.3.10";
constexpr std::string_view kImplicit = "1.2.840.10008.1.2";
constexpr std::string_view kExplicit = "1.2.840.10008.1.2.1";
constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";
constexpr std::string_view kBigEndian = "1.2.840.10008.1.2.2";
constexpr std::string_view kRunLength = "1.2.840.10008.1.2.5";
constexpr std::string_view kJpegFamily = "1.2.840.10008.1.2.4.";
constexpr std::string_view kJpegLs = "1.2.840.10008.1.2.4.8";
constexpr std::string_view kJpeg2000 = "1.2.840.10008.1.2.4.9";

bool is_plain(std::string_view syntax) {
  return syntax == kImplicit || syntax == kExplicit || syntax == kDeflated || syntax == kBigEndian;
}

void take_number(DicomSlice& slice, const DicomElementWalk& walk, const DicomElement& element) {
  if (element.length < 2) return;
  const auto value = static_cast<int>(walk.number(element.value, 2));
  switch (element.tag) {
    case 0x00280002:
      slice.samples = value;
      break;
    case 0x00280010:
      slice.rows = value;
      break;
    case 0x00280011:
      slice.columns = value;
      break;
    case 0x00280100:
      slice.bits = value;
      break;
    case 0x00280101:
      slice.stored = value;
      break;
    case 0x00280102:
      slice.high = value;
      break;
    case 0x00280103:
      slice.is_signed = value != 0;
      break;
    default:
      break;
  }
}

void take_text(DicomSlice& slice, const DicomElementWalk& walk, const DicomElement& element) {
  struct Known {
    std::uint32_t tag;
    std::string DicomSlice::*field;
  };
  static constexpr std::array<Known, 17> kKnown{{{0x00080018, &DicomSlice::image},
                                                 {0x00080016, &DicomSlice::media},
                                                 {0x00020002, &DicomSlice::media},
                                                 {0x00020010, &DicomSlice::syntax},
                                                 {0x00080008, &DicomSlice::image_type},
                                                 {0x0008103e, &DicomSlice::description},
                                                 {0x00180050, &DicomSlice::thickness},
                                                 {0x00180088, &DicomSlice::slice_spacing},
                                                 {0x0020000e, &DicomSlice::series},
                                                 {0x00200013, &DicomSlice::instance},
                                                 {0x00200032, &DicomSlice::position},
                                                 {0x00200037, &DicomSlice::orientation},
                                                 {0x00280004, &DicomSlice::photometric},
                                                 {0x00280008, &DicomSlice::frames},
                                                 {0x00280030, &DicomSlice::pixel_spacing},
                                                 {0x00281052, &DicomSlice::intercept},
                                                 {0x00281053, &DicomSlice::slope}}};
  for (const Known& known : kKnown) {
    if (known.tag == element.tag) slice.*known.field = walk.text(element);
  }
}

void take(DicomSlice& slice, const DicomElementWalk& walk, const DicomElement& element) {
  constexpr std::uint32_t kModalityTable = 0x00283000;
  slice.has_table = slice.has_table || element.tag == kModalityTable;
  constexpr std::uint32_t kDoseScaling = 0x3004000e;
  take_number(slice, walk, element);
  take_text(slice, walk, element);
  take_moment(slice.moments, walk, element);
  // A dose has no Rescale Slope.
  if (element.tag == kDoseScaling && slice.slope.empty()) slice.slope = walk.text(element);
}

// The first bytes from `begin` on.
std::string bytes_as_text(DicomBytes& file, std::uint64_t begin) {
  std::string text(kDicomHeadBytes, '\0');
  text.resize(file.read_at(begin, std::as_writable_bytes(std::span(text))));
  return text;
}

// The group before the data set, which says how that is written. Where it does not, or is not there, the data set says
// it itself.
void read_meta_group(DicomSlice& slice, DicomBytes& file) {
  DicomElementWalk walk(file, has_dicom_magic(bytes_as_text(file, 0)) ? kDicomMagicEnd : 0);
  while (!walk.at_end() && walk.next_group() == 2) take(slice, walk, walk.next());
  slice.data_set = walk.position();
  std::string& syntax = slice.syntax;
  if (syntax.empty()) syntax = told_syntax(bytes_as_text(file, slice.data_set));
  const bool known = is_plain(syntax) || syntax == kRunLength || syntax.starts_with(kJpegFamily);
  if (!known) {
    bad_input(slice.path, "a transfer syntax of plain, deflated, JPEG, JPEG-LS, JPEG 2000 or RLE samples",
              in_quotes(syntax));
  }
}

// The data set: what its top level says of all slices, what groups of it say of each frame, and the samples.
void read_data_set(DicomSlice& slice, DicomFrames& frames, DicomElementWalk& walk) {
  while (!walk.at_end()) {
    const DicomElement element = walk.next();
    const bool packed = element.tag == DicomElement::kPixelData && element.length == DicomElement::kUndefined;
    // Sequences may hold images of their own, such as an icon.
    const bool own = walk.depth() == 0;
    DicomFragments fragments;
    if (packed) fragments = walk.fragments();
    if (own && element.tag == DicomElement::kPixelData) {
      if (packed && is_plain(slice.syntax)) {
        bad_input(slice.path, "plain samples, as the transfer syntax says or none says otherwise", "packed ones");
      }
      frames.set_samples(packed, std::move(fragments), {element.value, element.length});
      return;
    }
    if (own) take(slice, walk, element);
    frames.take(walk, element);
  }
}

// Takes the bits that are used: the others may hold an overlay, and may not repeat the sign.
template <class Sample>
void clean(std::span<std::byte> samples, const DicomSlice& slice) {
  using Word = std::make_unsigned_t<Sample>;
  const int above = slice.bits - 1 - slice.high;
  const int below = slice.bits - slice.stored;
  for (std::size_t at = 0; at < samples.size(); at += sizeof(Word)) {
    Word word;
    std::memcpy(&word, samples.data() + at, sizeof(Word));
    // Shifts the bits to the top, then down with the sign of the type.
    const auto top = static_cast<Sample>(static_cast<Word>(word << above));
    const auto value = static_cast<Sample>(top >> below);
    std::memcpy(samples.data() + at, &value, sizeof(Word));
  }
}

void clean(std::span<std::byte> samples, const DicomSlice& slice, SampleType type) {
  visit_sample_type(type, [&]<class Sample>() {
    if constexpr (std::is_integral_v<Sample>) clean<Sample>(samples, slice);
  });
}

std::vector<std::byte> bytes_at(DicomBytes& file, const DicomRange& range) {
  std::vector<std::byte> bytes(to_size(range.second));
  if (file.read_at(range.first, bytes) < bytes.size()) {
    bad_input(file.path(), std::to_string(range.second) + " bytes of samples", "fewer");
  }
  return bytes;
}

// Samples of 1 bit as bytes. The lowest bit of a stored byte is the first of its eight samples.
std::vector<std::byte> bytes_of_bits(std::span<const std::byte> bits, std::size_t first, std::size_t count) {
  std::vector<std::byte> bytes(count);
  for (std::size_t n = 0; n < count; ++n) bytes[n] = bits[(first + n) / 8] >> (first + n) % 8 & std::byte{1};
  return bytes;
}

std::vector<std::byte> plain_samples(const DicomSlice& slice, DicomBytes& file, std::size_t bytes) {
  const std::uint64_t stored = slice.bits == 1 ? slice.plain_bytes() : bytes;
  if (slice.pixel_bytes() < stored) {
    bad_input(slice.path, std::to_string(stored) + " bytes of samples", std::to_string(slice.pixel_bytes()));
  }
  std::vector<std::byte> samples = bytes_at(file, {slice.pixels.front().first, stored});
  const bool big = slice.syntax == kBigEndian;
  if (big && slice.bits != 16) bad_input(slice.path, "big-endian samples of 16 bits", std::to_string(slice.bits));
  if (slice.bits == 1) return bytes_of_bits(samples, static_cast<std::size_t>(slice.first_bit), bytes);
  if (big != (std::endian::native == std::endian::big)) {
    swap_sample_bytes(samples, static_cast<std::size_t>(slice.bits) / 8);
  }
  return samples;
}

std::vector<std::byte> unpacked_samples(const DicomSlice& slice, DicomBytes& file, std::size_t bytes) {
  // One frame is one stream, in however many fragments it was written.
  std::vector<std::byte> packed;
  for (const DicomRange& range : slice.pixels) {
    const std::vector<std::byte> fragment = bytes_at(file, range);
    packed.insert(packed.end(), fragment.begin(), fragment.end());
  }
  if (slice.syntax == kRunLength) return unpack_run_lengths(slice, packed, bytes);
  check_frame_header(slice, packed);
  if (slice.syntax.starts_with(kJpegLs)) return unpack_jpegls(slice, packed, bytes);
  if (slice.syntax.starts_with(kJpeg2000)) return unpack_jpeg2000(slice, packed, bytes);
  return unpack_jpeg(slice, packed, bytes);
}

// The bytes of a file whose data set begins at byte `begin`.
DicomBytesPtr bytes_of(const std::string& path, std::string_view syntax, std::uint64_t begin) {
  return syntax == kDeflated ? inflated_bytes(open_file(path), begin) : plain_bytes(open_file(path));
}

std::vector<std::byte> samples_as_stored(const DicomSlice& slice, std::size_t bytes) {
  const DicomBytesPtr file = slice.bytes ? slice.bytes : bytes_of(slice.file, slice.syntax, slice.data_set);
  return slice.packed ? unpacked_samples(slice, *file, bytes) : plain_samples(slice, *file, bytes);
}

// Whether bits above `high` are neither all 0 nor, in signed samples, all as the sign is.
template <class Sample>
bool has_bits_above(std::span<const std::byte> samples, int high) {
  for (std::size_t at = 0; at < samples.size(); at += sizeof(Sample)) {
    Sample sample;
    std::memcpy(&sample, samples.data() + at, sizeof(Sample));
    // Shifts of signed samples repeat their sign.
    const auto above = static_cast<Sample>(sample >> (high + 1));
    const auto from_sign = static_cast<Sample>(sample >> high);
    const bool is_sign = std::is_signed_v<Sample> && from_sign == static_cast<Sample>(-1);
    if (above != 0 && !is_sign) return true;
  }
  return false;
}

}  // namespace

std::uint64_t DicomSlice::pixel_bytes() const {
  std::uint64_t sum = 0;
  for (const DicomRange& range : pixels) sum += range.second;
  return sum;
}

// All four are numbers of 16 bits.
std::uint64_t DicomSlice::plain_bits() const {
  return static_cast<std::uint64_t>(rows * columns) *
         (static_cast<std::uint64_t>(bits) * static_cast<std::uint64_t>(samples));
}

std::uint64_t DicomSlice::plain_bytes() const { return (static_cast<std::uint64_t>(first_bit) + plain_bits() + 7) / 8; }

std::string DicomSlice::name() const {
  const std::size_t last = path.rfind('/');
  if (last == std::string::npos || last == 0) return path;
  const std::size_t folder = path.rfind('/', last - 1);
  return folder == std::string::npos ? path : path.substr(folder + 1);
}

std::vector<DicomSlice> read_dicom_header(const std::string& path) {
  const DicomBytesPtr head = plain_bytes(open_file(path));
  DicomSlice slice;
  slice.file = slice.path = path;
  read_meta_group(slice, *head);
  if (slice.media == kDirectory) return {};
  const DicomBytesPtr bytes = slice.syntax == kDeflated ? bytes_of(path, slice.syntax, slice.data_set) : head;
  DicomElementWalk walk(*bytes, slice.data_set);
  walk.set_form(slice.syntax != kImplicit, slice.syntax == kBigEndian);
  DicomFrames frames(*bytes);
  read_data_set(slice, frames, walk);
  if (slice.rows == 0 || slice.columns == 0) return {};
  std::vector<DicomSlice> slices = frames.slices(slice);
  // A file of a series is opened again when it is its turn: there may be more of them than can be open at once.
  if (slices.size() > 1) {
    for (DicomSlice& one : slices) one.bytes = bytes;
  }
  return slices;
}

bool is_dicomdir(const std::string& path) {
  DicomSlice slice;
  slice.file = slice.path = path;
  read_meta_group(slice, *plain_bytes(open_file(path)));
  return slice.media == kDirectory;
}

bool has_bits_above(const DicomSlice& slice, SampleType type, std::size_t bytes) {
  if (slice.high + 1 >= slice.bits) return false;
  const std::vector<std::byte> samples = samples_as_stored(slice, bytes);
  return visit_sample_type(type, [&]<class Sample>() {
    if constexpr (std::is_integral_v<Sample>) return has_bits_above<Sample>(samples, slice.high);
    return false;
  });
}

bool is_copy(const DicomSlice& a, const DicomSlice& b) {
  if (a.image != b.image || a.syntax != b.syntax || a.pixels.size() != b.pixels.size()) return false;
  if (a.frame != b.frame) return false;
  const DicomBytesPtr first = bytes_of(a.file, a.syntax, a.data_set);
  const DicomBytesPtr second = bytes_of(b.file, b.syntax, b.data_set);
  return std::equal(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), [&](const DicomRange& x, const DicomRange& y) {
    return x.second == y.second && bytes_at(*first, x) == bytes_at(*second, y);
  });
}

std::vector<std::byte> decode_dicom(const DicomSlice& slice, SampleType type, std::size_t bytes) {
  std::vector<std::byte> samples = samples_as_stored(slice, bytes);
  clean(samples, slice, type);
  return samples;
}

}  // namespace isoweave
