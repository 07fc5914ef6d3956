// What zlib makes of the bytes of a test.
#pragma once

#include <zlib.h>

#include <string>

namespace isoweave::testing {

// zlib's wrapping of `window_bits`: 15 zlib, 31 gzip.
inline std::string deflated(const std::string& data, int window_bits) {
  z_stream zlib{};
  deflateInit2(&zlib, 6, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&zlib, data.size()) + 64, '\0');
  std::string in = data;
  zlib.next_in = reinterpret_cast<Bytef*>(in.data());
  zlib.avail_in = static_cast<uInt>(in.size());
  zlib.next_out = reinterpret_cast<Bytef*>(out.data());
  zlib.avail_out = static_cast<uInt>(out.size());
  deflate(&zlib, Z_FINISH);
  out.resize(zlib.total_out);
  deflateEnd(&zlib);
  return out;
}

inline std::string gzipped(const std::string& data) { return deflated(data, 31); }
inline std::string zlibbed(const std::string& data) { return deflated(data, 15); }

}  // namespace isoweave::testing
