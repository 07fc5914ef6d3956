// DICOM segmentations for tests.
#pragma once

#include "dicom_helpers.hpp"

namespace isoweave::testing::dicom_files {

// A frame of a segment at a place, with the samples that are in it.
struct SegmentFrame {
  int segment = 1;
  double z = 30;
  std::vector<std::size_t> within{};
  int value = 1;
};

inline std::string segment_number(std::uint16_t low, int value) {
  return element(0x62, low, "US", bytes_of(static_cast<std::uint16_t>(value)));
}

// The groups of a frame; without a segment where that is 0.
inline std::string groups_of(const SegmentFrame& frame) {
  const std::string place = frame_at(frame.z);
  return frame.segment == 0 ? place : group(0x62, 0xa, segment_number(0xb, frame.segment)) + place;
}

struct NamedSegment {
  int number;
  std::string name;
};

// The elements of a header that are about segments.
struct SaidOfSegments {
  std::string type = "BINARY";
  std::vector<NamedSegment> segments{};
  std::string overlap{};
  std::string more{};
};

inline std::string header_of(const SaidOfSegments& said) {
  std::string items;
  for (const NamedSegment& segment : said.segments) {
    items +=
        item(segment_number(4, segment.number) + element(0x62, 5, "LO", segment.name) +
             element(0x62, 0xd, "US",
                     bytes_of(std::uint16_t{65535}) + bytes_of(std::uint16_t{32896}) + bytes_of(std::uint16_t{32896})));
  }
  std::string header = said.type.empty() ? "" : element(0x62, 1, "CS", said.type);
  if (!items.empty()) header += element(0x62, 2, "SQ", items);
  if (!said.overlap.empty()) header += element(0x62, 0x13, "CS", said.overlap);
  return header + said.more;
}

// One bit for each sample, the lowest one first, frames without a gap between them.
inline std::string bits_of(const std::vector<SegmentFrame>& frames) {
  std::string bits((frames.size() * kSlice + 7) / 8, '\0');
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (const std::size_t n : frames[f].within) {
      const std::size_t bit = f * kSlice + n;
      bits[bit / 8] = static_cast<char>(static_cast<unsigned char>(bits[bit / 8]) | 1U << bit % 8);
    }
  }
  return bits;
}

inline std::string bytes_of_frames(const std::vector<SegmentFrame>& frames) {
  std::string bytes;
  for (const SegmentFrame& frame : frames) {
    std::string samples(kSlice, '\0');
    for (const std::size_t n : frame.within) samples[n] = static_cast<char>(frame.value);
    bytes += samples;
  }
  return bytes;
}

inline std::string with_class(std::string file, const std::string& uid) {
  const std::string before = element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2");
  return file.replace(file.find(before), before.size(), element(8, 0x16, "UI", uid));
}

inline std::string segmentation(const std::vector<SegmentFrame>& frames, const SaidOfSegments& said,
                                DicomFields fields = {}) {
  const bool binary = said.type == "BINARY";
  std::vector<std::string> groups;
  for (const SegmentFrame& frame : frames) groups.push_back(groups_of(frame));
  fields.bits = binary ? 1 : 8;
  fields.more = header_of(said);
  return with_class(enhanced(groups, binary ? bits_of(frames) : bytes_of_frames(frames), fields),
                    "1.2.840.10008.5.1.4.1.1.66.4");
}

}  // namespace isoweave::testing::dicom_files
