// DICOM files for tests.
#pragma once

#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>

#include "volume_helpers.hpp"

namespace isoweave::testing::dicom_files {

constexpr int kColumns = 7;
constexpr int kRows = 5;
constexpr std::size_t kSlice = kColumns * kRows;

// One element in explicit little-endian form.
inline std::string element(std::uint16_t group, std::uint16_t number, const std::string& vr, std::string value) {
  const bool binary = vr == "US" || vr == "OW" || vr == "UL" || vr == "SQ";
  if (value.size() % 2 != 0) value += binary || vr == "UI" ? '\0' : ' ';
  const auto size = static_cast<std::uint32_t>(value.size());
  std::string text = bytes_of(group) + bytes_of(number) + vr;
  text += vr == "OW" || vr == "SQ" ? std::string(2, '\0') + bytes_of(size) : bytes_of(static_cast<std::uint16_t>(size));
  return text + value;
}

inline std::string us(std::uint16_t number, int value) {
  return element(0x28, number, "US", bytes_of(static_cast<std::uint16_t>(value)));
}

struct DicomFields {
  std::string series = "1.2.3";
  std::string description = "thin";
  std::string position = "10\\20\\30";
  std::string orientation = "1\\0\\0\\0\\1\\0";
  std::string pixel_spacing = "0.5\\0.25";
  std::string slope, intercept, frames, thickness;
  std::string photometric = "MONOCHROME2";
  int columns = kColumns;
  int rows = kRows;
  int bits = 16;
  int is_signed = 0;
  int samples = 1;
  std::string more;  // elements behind (0028,1053)
};

inline std::string dicom(const DicomFields& fields, const std::string& samples) {
  const std::string syntax = element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  const std::string meta = element(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(2, 3, "UI", "1.9") + syntax;
  std::string file = std::string(128, '\0') + "DICM";
  file += element(2, 0, "UL", bytes_of(static_cast<std::uint32_t>(meta.size()))) + meta;
  file += element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(8, 0x18, "UI", "1.9");
  file += element(8, 0x60, "CS", "CT") + element(8, 0x103e, "LO", fields.description);
  if (!fields.thickness.empty()) file += element(0x18, 0x50, "DS", fields.thickness);
  file += element(0x20, 0xe, "UI", fields.series);
  if (!fields.position.empty()) file += element(0x20, 0x32, "DS", fields.position);
  if (!fields.orientation.empty()) file += element(0x20, 0x37, "DS", fields.orientation);
  file += us(2, fields.samples) + element(0x28, 4, "CS", fields.photometric);
  if (!fields.frames.empty()) file += element(0x28, 8, "IS", fields.frames);
  file += us(0x10, fields.rows) + us(0x11, fields.columns);
  if (!fields.pixel_spacing.empty()) file += element(0x28, 0x30, "DS", fields.pixel_spacing);
  file += us(0x100, fields.bits) + us(0x101, fields.bits) + us(0x102, fields.bits - 1) + us(0x103, fields.is_signed);
  if (!fields.intercept.empty()) file += element(0x28, 0x1052, "DS", fields.intercept);
  if (!fields.slope.empty()) file += element(0x28, 0x1053, "DS", fields.slope);
  return file + fields.more + element(0x7fe0, 0x10, "OW", samples);
}

inline const std::vector<std::uint16_t> kSamples = ramp<std::uint16_t>(kSlice * 5);

inline std::string slice(std::size_t n) { return stored(kSamples).substr(2 * kSlice * n, 2 * kSlice); }

inline std::string at(double z) { return "10\\20\\" + std::to_string(z); }

// Five slices 2.5 apart, whose names are in the order opposite to that of their positions.
inline void put_series(const TempFolder& folder, DicomFields fields = {}) {
  for (std::size_t n = 0; n < 5; ++n) {
    fields.position = at(30 + 2.5 * static_cast<double>(n));
    folder.put("s" + std::to_string(9 - n), dicom(fields, slice(n)));
  }
}

// The elements behind the meta group without any wrapping, as this transfer syntax has them.
inline std::string deflated_file(const std::string& file) {
  const std::size_t syntax = file.find(element(2, 0x10, "UI", "1.2.840.10008.1.2.1"));
  const std::size_t end = syntax + element(2, 0x10, "UI", "1.2.840.10008.1.2.1").size();
  return file.substr(0, syntax) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1.99") + deflated(file.substr(end), -15);
}

inline const std::string kItem("\xfe\xff\x00\xe0", 4);

inline std::string item(const std::string& content) {
  return kItem + bytes_of(static_cast<std::uint32_t>(content.size())) + content;
}

inline std::string group(std::uint16_t high, std::uint16_t low, const std::string& macro) {
  return element(high, low, "SQ", item(macro));
}

// An enhanced image: what all frames share, then what each has of its own.
inline std::string enhanced(const std::vector<std::string>& frames, const std::string& samples,
                            DicomFields fields = {}) {
  fields.frames = fields.frames.empty() ? std::to_string(frames.size()) : fields.frames;
  fields.position.clear();
  fields.orientation.clear();
  fields.pixel_spacing.clear();
  const std::string shared = group(0x20, 0x9116, element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")) +
                             group(0x28, 0x9110, element(0x28, 0x30, "DS", "0.5\\0.25")) +
                             group(0x28, 0x9145, element(0x28, 0x1052, "DS", "-7") + element(0x28, 0x1053, "DS", "2"));
  std::string items;
  for (const std::string& frame : frames) items += item(frame);
  fields.more += element(0x5200, 0x9229, "SQ", item(shared)) + element(0x5200, 0x9230, "SQ", items);
  return dicom(fields, samples);
}

inline std::string frame_at(double z) { return group(0x20, 0x9113, element(0x20, 0x32, "DS", at(z))); }

// Packed samples: the table of offsets and the fragments that `content` has.
inline std::string packed_frames(const std::vector<std::string>& frames, const std::string& content) {
  std::string file = enhanced(frames, "");
  const std::string plain = element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  file.replace(file.find(plain), plain.size(), element(2, 0x10, "UI", "1.2.840.10008.1.2.5"));
  file.resize(file.size() - element(0x7fe0, 0x10, "OW", "").size());
  return file + bytes_of(std::uint16_t{0x7fe0}) + bytes_of(std::uint16_t{0x10}) + std::string("OB\0\0", 4) +
         bytes_of(0xffffffffU) + content + std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8);
}

// One image whose samples are one packed stream.
inline std::string packed_image(const DicomFields& fields, const std::string& syntax, std::string stream) {
  if (stream.size() % 2 != 0) stream += '\0';
  std::string file = dicom(fields, "");
  file.resize(file.size() - element(0x7fe0, 0x10, "OW", "").size());
  const std::string plain = element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  const std::string packed = element(2, 0x10, "UI", syntax);
  file.replace(file.find(plain), plain.size(), packed);
  const std::string meta = element(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(2, 3, "UI", "1.9");
  const auto size = [&](const std::string& last) {
    return element(2, 0, "UL", bytes_of(static_cast<std::uint32_t>(meta.size() + last.size())));
  };
  file.replace(file.find(size(plain)), size(plain).size(), size(packed));
  return file + bytes_of(std::uint16_t{0x7fe0}) + bytes_of(std::uint16_t{0x10}) + std::string("OB\0\0", 4) +
         bytes_of(0xffffffffU) + item("") + item(stream) + std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8);
}

// A slice as run lengths: the more significant bytes of its samples, then the less significant, all literal.
inline std::string run_lengths(const std::string& slice) {
  std::string high;
  std::string low;
  for (std::size_t n = 0; n < slice.size(); n += 2) {
    low += slice[n];
    high += slice[n + 1];
  }
  const std::string first = static_cast<char>(high.size() - 1) + high;
  const std::string second = static_cast<char>(low.size() - 1) + low;
  std::string header = bytes_of(2U) + bytes_of(64U) + bytes_of(static_cast<std::uint32_t>(64 + first.size()));
  header.resize(64);
  return header + first + second;
}

// Rewrites a file in another transfer syntax.
inline bool transcode(const std::string& from, const std::string& to, gdcm::TransferSyntax::TSType syntax) {
  gdcm::ImageReader reader;
  reader.SetFileName(from.c_str());
  if (!reader.Read()) return false;
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(gdcm::TransferSyntax(syntax));
  change.SetInput(reader.GetImage());
  if (!change.Change()) return false;
  gdcm::ImageWriter writer;
  writer.SetFile(reader.GetFile());
  writer.SetImage(change.GetOutput());
  writer.SetFileName(to.c_str());
  return writer.Write();
}

}  // namespace isoweave::testing::dicom_files
