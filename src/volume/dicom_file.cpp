// The elements of a DICOM file are read here, not by GDCM: its parser allocates what an element claims to hold, and
// ends the program on some damaged files.
#include "volume/dicom_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "volume/dicom_packed.hpp"
#include "volume/formats.hpp"
#include "volume/header_text.hpp"
#include "volume/printable.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::uint32_t kItem = 0xfffee000;
constexpr std::uint32_t kItemEnd = 0xfffee00d;
constexpr std::uint32_t kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kPixelData = 0x7fe00010;
constexpr std::uint32_t kUndefined = 0xffffffff;

constexpr std::string_view kImplicit = "1.2.840.10008.1.2";
constexpr std::string_view kExplicit = "1.2.840.10008.1.2.1";
constexpr std::string_view kBigEndian = "1.2.840.10008.1.2.2";
constexpr std::string_view kRunLength = "1.2.840.10008.1.2.5";
constexpr std::string_view kJpegFamily = "1.2.840.10008.1.2.4.";
constexpr std::string_view kJpeg2000 = "1.2.840.10008.1.2.4.9";

struct Element {
  std::uint32_t tag = 0;
  std::string vr;  // empty where it is implicit
  std::uint32_t length = 0;
  std::uint64_t value = 0;  // where its value begins
};

// Steps through the elements of a file, into sequences and items.
class ElementWalk {
 public:
  explicit ElementWalk(const InputFile& file) : file_(file) {}

  void set_syntax(std::string_view syntax) {
    explicit_ = syntax != kImplicit;
    big_endian_ = syntax == kBigEndian;
  }

  bool at_end() const { return position_ >= file_.size(); }
  // Whether the element that next() gave lies in no sequence.
  bool at_top() const { return top_; }
  std::uint32_t next_group() const { return number(position_, 2); }

  // The next element; the walk goes on behind it, or inside it where it holds elements.
  Element next() {
    while (!ends_.empty() && ends_.back() != kOpen && position_ >= ends_.back()) ends_.pop_back();
    Element element = header();
    const std::uint64_t left = file_.size() - std::min(element.value, file_.size());
    if (element.length != kUndefined && element.length > left) {
      bad_input(file_.path(),
                std::to_string(element.length) + " bytes of a DICOM element from byte " +
                    std::to_string(element.value) + " on",
                "a file of " + std::to_string(file_.size()));
    }
    if ((element.tag == kItemEnd || element.tag == kSequenceEnd) && !ends_.empty()) ends_.pop_back();
    top_ = ends_.empty();
    position_ = element.value;
    if (is_container(element)) {
      enter(element);
    } else if (element.length != kUndefined) {
      position_ += element.length;
    }
    return element;
  }

  std::uint32_t number(std::uint64_t at, std::size_t bytes) const {
    std::array<std::byte, 4> raw{};
    const std::span<std::byte> wanted = std::span(raw).first(bytes);
    if (file_.read_at(at, wanted) < bytes) {
      bad_input(file_.path(), "a DICOM element at byte " + std::to_string(at),
                "a file of " + std::to_string(file_.size()));
    }
    if (!big_endian_) std::reverse(wanted.begin(), wanted.end());
    std::uint32_t value = 0;
    for (const std::byte byte : wanted) value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
  }

  // The first bytes of a value, without the blank or zero that makes its length even.
  std::string text(const Element& element) const {
    constexpr std::uint32_t kLongest = 4096;
    std::string result(std::min(element.length, kLongest), '\0');
    result.resize(file_.read_at(element.value, std::as_writable_bytes(std::span(result))));
    return std::string(trimmed(std::string_view(result).substr(0, result.find('\0'))));
  }

  // The items behind the start of packed samples, the first of which is a table of offsets.
  std::vector<DicomSlice::Range> fragments() {
    std::vector<DicomSlice::Range> ranges;
    while (true) {
      const Element element = header();
      if (element.tag == kSequenceEnd) {
        position_ = element.value;
        break;
      }
      const std::uint64_t left = file_.size() - std::min(element.value, file_.size());
      if (element.tag != kItem || element.length > left) {
        bad_input(file_.path(), "an item of packed samples at byte " + std::to_string(position_), "none");
      }
      ranges.emplace_back(element.value, element.length);
      position_ = element.value + element.length;
    }
    if (!ranges.empty()) ranges.erase(ranges.begin());
    return ranges;
  }

 private:
  static constexpr std::uint64_t kOpen = ~std::uint64_t{0};

  Element header() const {
    Element element;
    element.tag = number(position_, 2) << 16 | number(position_ + 2, 2);
    element.value = position_ + 8;
    const bool frame = element.tag >> 16 == kItem >> 16;
    if (!explicit_ || frame) {
      element.length = number(position_ + 4, 4);
      return element;
    }
    static constexpr std::array<std::string_view, 13> kLong{"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                            "SV", "UC", "UN", "UR", "UT", "UV"};
    element.vr.resize(2);
    file_.read_at(position_ + 4, std::as_writable_bytes(std::span(element.vr)));
    if (std::find(kLong.begin(), kLong.end(), element.vr) == kLong.end()) {
      element.length = number(position_ + 6, 2);
    } else {
      element.length = number(position_ + 8, 4);
      element.value = position_ + 12;
    }
    return element;
  }

  bool is_container(const Element& element) const {
    if (element.tag == kPixelData) return false;
    if (element.length == kUndefined || element.tag == kItem || element.vr == "SQ") return true;
    // Without a VR a sequence is known by its first item.
    return element.vr.empty() && element.length >= 8 && number(element.value, 2) == kItem >> 16 &&
           number(element.value + 2, 2) == (kItem & 0xffff);
  }

  void enter(const Element& element) {
    constexpr std::size_t kDeepest = 64;
    if (ends_.size() >= kDeepest) bad_input(file_.path(), "sequences no deeper than 64", "deeper ones");
    if (element.vr == "UN" && element.length == kUndefined) {
      bad_input(file_.path(), "sequences whose VR is known", "one of VR UN at byte " + std::to_string(element.value));
    }
    ends_.push_back(element.length == kUndefined ? kOpen : element.value + element.length);
  }

  const InputFile& file_;
  std::uint64_t position_ = kDicomHeadBytes;
  bool explicit_ = true;
  bool big_endian_ = false;
  bool top_ = true;
  std::vector<std::uint64_t> ends_;  // of the sequences and items that the position is in
};

void take_number(DicomSlice& slice, const ElementWalk& walk, const Element& element) {
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

void take_text(DicomSlice& slice, const ElementWalk& walk, const Element& element) {
  struct Known {
    std::uint32_t tag;
    std::string DicomSlice::*field;
  };
  static constexpr std::array<Known, 12> kKnown{{{0x00020010, &DicomSlice::syntax},
                                                 {0x0008103e, &DicomSlice::description},
                                                 {0x00180050, &DicomSlice::thickness},
                                                 {0x00180088, &DicomSlice::slice_spacing},
                                                 {0x0020000e, &DicomSlice::series},
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

void take(DicomSlice& slice, const ElementWalk& walk, const Element& element) {
  constexpr std::uint32_t kSharedGroups = 0x52009229;
  constexpr std::uint32_t kFrameGroups = 0x52009230;
  constexpr std::uint32_t kModalityTable = 0x00283000;
  slice.enhanced = slice.enhanced || element.tag == kSharedGroups || element.tag == kFrameGroups;
  slice.has_table = slice.has_table || element.tag == kModalityTable;
  take_number(slice, walk, element);
  take_text(slice, walk, element);
}

// The group before the data set, which says how that is written.
void read_meta_group(DicomSlice& slice, ElementWalk& walk) {
  while (!walk.at_end() && walk.next_group() == 2) take(slice, walk, walk.next());
  const bool known = slice.syntax == kImplicit || slice.syntax == kExplicit || slice.syntax == kBigEndian ||
                     slice.syntax == kRunLength || slice.syntax.starts_with(kJpegFamily);
  if (!known) {
    bad_input(slice.path, "a transfer syntax of plain, JPEG, JPEG-LS, JPEG 2000 or RLE samples", quoted(slice.syntax));
  }
  walk.set_syntax(slice.syntax);
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
    // To the top, then down with the sign of the type.
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

std::vector<std::byte> bytes_at(const InputFile& file, const DicomSlice::Range& range) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(range.second));
  if (file.read_at(range.first, bytes) < bytes.size()) {
    bad_input(file.path(), std::to_string(range.second) + " bytes of samples", "fewer");
  }
  return bytes;
}

std::vector<std::byte> plain_samples(const DicomSlice& slice, const InputFile& file, std::size_t bytes) {
  if (slice.pixel_bytes() < bytes) {
    bad_input(slice.path, std::to_string(bytes) + " bytes of samples", std::to_string(slice.pixel_bytes()));
  }
  std::vector<std::byte> samples = bytes_at(file, {slice.pixels.front().first, bytes});
  const bool big = slice.syntax == kBigEndian;
  if (big && slice.bits != 16) bad_input(slice.path, "big-endian samples of 16 bits", std::to_string(slice.bits));
  if (big != (std::endian::native == std::endian::big)) {
    swap_sample_bytes(samples, static_cast<std::size_t>(slice.bits) / 8);
  }
  return samples;
}

}  // namespace

std::uint64_t DicomSlice::pixel_bytes() const {
  std::uint64_t sum = 0;
  for (const Range& range : pixels) sum += range.second;
  return sum;
}

std::optional<DicomSlice> read_dicom_header(const std::string& path) {
  const auto file = open_file(path);
  DicomSlice slice;
  slice.path = path;
  ElementWalk walk(*file);
  read_meta_group(slice, walk);
  while (!walk.at_end() && slice.pixels.empty()) {
    const Element element = walk.next();
    const bool packed = element.tag == kPixelData && element.length == kUndefined;
    std::vector<DicomSlice::Range> pixels;
    if (packed) pixels = walk.fragments();
    // Sequences may hold images of their own, such as an icon.
    if (!walk.at_top()) continue;
    if (element.tag != kPixelData) {
      take(slice, walk, element);
      continue;
    }
    if (!packed) pixels.emplace_back(element.value, element.length);
    slice.packed = packed;
    slice.pixels = std::move(pixels);
  }
  if (slice.rows == 0 || slice.columns == 0) return std::nullopt;
  if (slice.pixels.empty()) bad_input(path, "samples (Pixel Data)", "none");
  return slice;
}

std::vector<std::byte> decode_dicom(const DicomSlice& slice, SampleType type, std::size_t bytes) {
  const auto file = open_file(slice.path);
  std::vector<std::byte> samples;
  if (slice.packed) {
    // One frame is one stream, in however many fragments it was written.
    std::vector<std::byte> packed;
    for (const DicomSlice::Range& range : slice.pixels) {
      const std::vector<std::byte> fragment = bytes_at(*file, range);
      packed.insert(packed.end(), fragment.begin(), fragment.end());
    }
    if (slice.syntax == kRunLength) {
      samples = unpack_run_lengths(slice, packed, bytes);
    } else {
      check_frame_header(slice, packed);
      const bool jpeg2000 = slice.syntax.starts_with(kJpeg2000);
      samples = jpeg2000 ? unpack_jpeg2000(slice, packed, bytes) : unpack_jpeg(slice, packed, bytes);
    }
  } else {
    samples = plain_samples(slice, *file, bytes);
  }
  clean(samples, slice, type);
  return samples;
}

}  // namespace isoweave
