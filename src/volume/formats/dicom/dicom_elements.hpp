// The elements of a DICOM file. They are read here, not by GDCM: its parser allocates what an element claims to hold,
// and ends the program on some damaged files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "volume/formats/dicom/dicom_bytes.hpp"

namespace isoweave {

struct DicomElement {
  static constexpr std::uint32_t kItem = 0xfffee000;
  static constexpr std::uint32_t kItemEnd = 0xfffee00d;
  static constexpr std::uint32_t kSequenceEnd = 0xfffee0dd;
  static constexpr std::uint32_t kPixelData = 0x7fe00010;
  static constexpr std::uint32_t kUndefined = 0xffffffff;

  std::uint32_t tag = 0;
  std::string vr;  // empty where it is implicit
  std::uint32_t length = 0;
  std::uint64_t value = 0;  // where its value begins
};

// Whether the length of a value of this VR has four bytes; else it has two.
bool has_long_length(std::string_view vr);

using DicomRange = std::pair<std::uint64_t, std::uint64_t>;  // first byte, number of bytes

// Packed samples: a table of offsets, which may be empty, and fragments.
struct DicomFragments {
  DicomRange table;
  std::vector<DicomRange> list;
};

// Steps through the elements of a file, into sequences and items. Nothing is allocated that an element merely claims.
class DicomElementWalk {
 public:
  DicomElementWalk(DicomBytes& file, std::uint64_t position) : file_(file), position_(position) {}

  void set_form(bool is_explicit, bool big_endian) {
    explicit_ = is_explicit;
    big_endian_ = big_endian;
  }

  bool is_big_endian() const { return big_endian_; }
  std::uint64_t position() const { return position_; }
  bool at_end() const { return position_ >= file_.size(); }
  // Sequences and items that the element that next() gave lies in.
  std::size_t depth() const { return depth_; }
  std::uint32_t next_group() const { return number(position_, 2); }

  // The next element; the walk goes on behind it, or inside it where it holds elements.
  DicomElement next();

  std::uint32_t number(std::uint64_t at, std::size_t bytes) const;

  // The first bytes of a value, at most `longest`, without the blank or zero that makes its length even.
  std::string text(const DicomElement& element, std::size_t longest = 4096) const;

  // The items behind the start of packed samples.
  DicomFragments fragments();

 private:
  static constexpr std::uint64_t kOpen = ~std::uint64_t{0};

  DicomElement header() const;
  bool is_container(const DicomElement& element) const;
  void enter(const DicomElement& element);

  DicomBytes& file_;
  std::uint64_t position_;
  bool explicit_ = true;
  bool big_endian_ = false;
  std::size_t depth_ = 0;
  std::vector<std::uint64_t> ends_;  // of the sequences and items that the position is in
};

}  // namespace isoweave
