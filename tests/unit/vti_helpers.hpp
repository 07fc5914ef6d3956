// VTI files for tests, in every encoding.
#pragma once

#include "volume_helpers.hpp"

namespace isoweave::testing::vti_files {

inline const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(4 * 3 * 5);

inline std::string base64(const std::string& bytes) {
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      bits = bits << 8 | (at + n < bytes.size() ? static_cast<unsigned char>(bytes[at + n]) : 0U);
    }
    for (std::size_t n = 0; n < 4; ++n) text += at + n > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * n) & 63];
  }
  return text;
}

// How an array is written.
struct VtiForm {
  bool big = false;
  bool wide = false;      // numbers of 8 bytes before an array
  std::size_t block = 0;  // bytes of the compressed blocks; 0: not compressed
  bool appended = false;
  bool base64 = true;
  std::string attributes = "type=\"Int16\" Name=\"a\"";
  std::string scalars = {};
  std::string place = R"(WholeExtent="0 3 0 2 0 4" Origin="0 0 0" Spacing="1 1 1")";
  std::string extent = "0 3 0 2 0 4";
  bool lz4 = false;  // the blocks
};

inline std::string word(const VtiForm& form, std::uint64_t value) {
  return form.wide ? bytes_of(value, form.big) : bytes_of(static_cast<std::uint32_t>(value), form.big);
}

inline std::string encoded(const VtiForm& form, const std::string& bytes) {
  return form.base64 ? base64(bytes) : bytes;
}

// An LZ4 block of one sequence of literals, which any data may be stored as.
inline std::string lz4_literals(const std::string& data) {
  constexpr std::size_t kShort = 15;
  if (data.size() < kShort) return static_cast<char>(data.size() << 4) + data;
  std::string block = "\xf0";
  std::size_t left = data.size() - kShort;
  for (; left >= 255; left -= 255) block += '\xff';
  return block + static_cast<char>(left) + data;
}

// The array with its sizes, as VTK writes it: those of compressed blocks are a piece of base64 of their own.
inline std::string array_of(const VtiForm& form, const std::string& samples) {
  if (form.block == 0) return encoded(form, word(form, samples.size()) + samples);
  std::string sizes;
  std::string blocks;
  std::uint64_t count = 0;
  for (std::size_t at = 0; at < samples.size(); at += form.block, ++count) {
    const std::string part = samples.substr(at, form.block);
    const std::string block = form.lz4 ? lz4_literals(part) : zlibbed(part);
    sizes += word(form, block.size());
    blocks += block;
  }
  sizes = word(form, count) + word(form, form.block) + word(form, samples.size() % form.block) + sizes;
  return encoded(form, sizes) + encoded(form, blocks);
}

inline std::string vti(const VtiForm& form, const std::string& array) {
  std::string text = "<?xml version=\"1.0\"?>\n<!-- <VTKFile type='no'> -->\n<VTKFile type=\"ImageData\" byte_order=\"";
  text += form.big ? "BigEndian\"" : "LittleEndian\"";
  if (form.wide) text += " header_type=\"UInt64\"";
  if (form.block > 0) text += std::string(" compressor=\"vtk") + (form.lz4 ? "LZ4" : "ZLib") + "DataCompressor\"";
  text += ">\n<ImageData " + form.place +
          ">\n<FieldData><DataArray type=\"Int8\" Name=\"f\" format=\"ascii\">1</DataArray>";
  text += "</FieldData><Piece Extent=\"" + form.extent + "\">\n<PointData Scalars=\"" + form.scalars + "\">\n";
  text += "<DataArray type=\"Float32\" Name=\"v\" NumberOfComponents=\"3\" format=\"ascii\"> 1 2 3 </DataArray>\n";
  text +=
      "<DataArray " + form.attributes + " format=\"" + (form.appended ? "appended\" offset=\"2\"/>" : "binary\">\n  ");
  if (!form.appended) text += array + "\n</DataArray>";
  text += "</PointData></Piece></ImageData>\n";
  if (form.appended) {
    text += std::string("<AppendedData encoding=\"") + (form.base64 ? "base64" : "raw") + "\">\n  _";
    // Another array, two characters long.
    text += "AA" + array + "\n</AppendedData>";
  }
  return text + "\n</VTKFile>\n";
}

inline std::string whole(const VtiForm& form) { return vti(form, array_of(form, stored(kSamples, form.big))); }

}  // namespace isoweave::testing::vti_files
