#include <zstd.h>

#include "files/input_file.hpp"
#include "volume/formats/chunked/chunk_codecs.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

std::vector<std::byte> decode_zstd(std::span<const std::byte> stored, std::size_t most, const std::string& path) {
  constexpr std::uint64_t kBlocksOfOneByte = 1 << 16;  // 128 KiB can be one block of 4 bytes
  check_plausible(path, most, stored.size(), kBlocksOfOneByte);
  std::vector<std::byte> decoded(most);
  const std::size_t got = ZSTD_decompress(decoded.data(), decoded.size(), stored.data(), stored.size());
  if (ZSTD_isError(got) != 0) {
    bad_input(path, "at most " + std::to_string(most) + " bytes in zstd", ZSTD_getErrorName(got));
  }
  decoded.resize(got);
  return decoded;
}

}  // namespace isoweave
