// Writers of formats whose header is a few numbers at fixed places, for tests and for the seeds of fuzzers.
#pragma once

#include <array>
#include <string>

#include "volume_helpers.hpp"

namespace isoweave::testing {

inline void put_at(std::string& header, std::size_t at, const std::string& bytes) {
  header.replace(at, bytes.size(), bytes);
}

template <class Stored, class Value, std::size_t kCount>
void put_numbers(std::string& header, std::size_t at, const std::array<Value, kCount>& values, bool big) {
  for (std::size_t n = 0; n < kCount; ++n) {
    put_at(header, at + n * sizeof(Stored), bytes_of(static_cast<Stored>(values[n]), big));
  }
}

// The dictionary in front of the samples, filled up as NumPy does.
inline std::string npy_header(const std::string& type, const std::string& shape, bool fortran = false,
                              int version = 1) {
  std::string text =
      "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
  text.resize(118, ' ');
  text.back() = '\n';
  const std::string length = version == 1 ? bytes_of(static_cast<std::uint16_t>(text.size()))
                                          : bytes_of(static_cast<std::uint32_t>(text.size()));
  return "\x93NUMPY" + std::string(1, static_cast<char>(version)) + std::string(1, '\0') + length + text;
}

struct MrcFields {
  bool big = false;
  std::array<int, 3> dims{3, 2, 5};
  int mode = 1;
  std::array<int, 3> start{0, 0, 0};
  std::array<int, 3> grid{3, 2, 5};
  std::array<double, 3> cell{15, 20, 100};  // 5, 10, 20 angstrom apart
  std::array<double, 3> angles{90, 90, 90};
  std::array<int, 3> axes{1, 2, 3};
  std::array<double, 2> range{0, 0};
  int group = 1;
  int extended = 0;
  int imod_flags = -1;  // -1: not written by IMOD
  std::array<double, 3> origin{0, 0, 0};
  bool magic = true;
};

inline std::string mrc_header(const MrcFields& fields) {
  std::string header(1024, '\0');
  put_numbers<std::int32_t>(header, 0, fields.dims, fields.big);
  put_at(header, 12, bytes_of(fields.mode, fields.big));
  put_numbers<std::int32_t>(header, 16, fields.start, fields.big);
  put_numbers<std::int32_t>(header, 28, fields.grid, fields.big);
  put_numbers<float>(header, 40, fields.cell, fields.big);
  put_numbers<float>(header, 52, fields.angles, fields.big);
  put_numbers<std::int32_t>(header, 64, fields.axes, fields.big);
  put_numbers<float>(header, 76, fields.range, fields.big);
  put_at(header, 88, bytes_of(fields.group, fields.big));
  put_at(header, 92, bytes_of(fields.extended, fields.big));
  if (fields.imod_flags >= 0) {
    put_at(header, 152, bytes_of(std::int32_t{1146047817}, fields.big));
    put_at(header, 156, bytes_of(fields.imod_flags, fields.big));
  }
  put_numbers<float>(header, 196, fields.origin, fields.big);
  if (fields.magic) put_at(header, 208, "MAP " + std::string(fields.big ? "\x11\x11" : "DA"));
  return header;
}

struct MghFields {
  std::array<int, 7> numbers{1, 3, 2, 5, 1, 4, 0};  // version, width, height, depth, frames, type, degrees of freedom
  bool placed = true;
  std::array<double, 3> spacing{0.5, 0.75, 2};
  std::array<double, 9> directions{-1, 0, 0, 0, 0, -1, 0, 1, 0};
  std::array<double, 3> centre{0, 0, 0};
};

inline std::string mgh_header(const MghFields& fields) {
  std::string header(284, '\0');
  put_numbers<std::int32_t>(header, 0, fields.numbers, true);
  put_at(header, 28, bytes_of(static_cast<std::int16_t>(fields.placed), true));
  put_numbers<float>(header, 30, fields.spacing, true);
  put_numbers<float>(header, 42, fields.directions, true);
  put_numbers<float>(header, 78, fields.centre, true);
  return header;
}

struct AnalyzeFields {
  bool big = false;
  std::array<int, 8> dim{4, 3, 2, 5, 1, 0, 0, 0};
  int type = 4;
  std::array<double, 8> pixdim{0, 0.5, 0.75, 2, 0, 0, 0, 0};
  double offset = 0;
  double scale = 0;
  int orientation = 0;
  std::array<int, 3> origin{0, 0, 0};
};

inline std::string analyze_header(const AnalyzeFields& fields) {
  std::string header(348, '\0');
  put_at(header, 0, bytes_of(std::int32_t{348}, fields.big));
  put_at(header, 32, bytes_of(std::int32_t{16384}, fields.big));
  header[38] = 'r';
  put_numbers<std::int16_t>(header, 40, fields.dim, fields.big);
  put_at(header, 70, bytes_of(static_cast<std::int16_t>(fields.type), fields.big));
  put_numbers<float>(header, 76, fields.pixdim, fields.big);
  put_at(header, 108, bytes_of(static_cast<float>(fields.offset), fields.big));
  put_at(header, 112, bytes_of(static_cast<float>(fields.scale), fields.big));
  header[252] = static_cast<char>(fields.orientation);
  put_numbers<std::int16_t>(header, 253, fields.origin, fields.big);
  return header;
}

}  // namespace isoweave::testing
