#include <blosc.h>

#include "files/input_file.hpp"
#include "volume/formats/chunked/chunk_codecs.hpp"

namespace isoweave {

std::vector<std::byte> decode_blosc(std::span<const std::byte> stored, std::size_t most, const std::string& path) {
  std::size_t bytes = 0;
  const bool whole = blosc_cbuffer_validate(stored.data(), stored.size(), &bytes) == 0;
  if (!whole || bytes > most) bad_input(path, "at most " + std::to_string(most) + " bytes in Blosc", "other data");
  std::vector<std::byte> decoded(bytes);
  const int got = blosc_decompress_ctx(stored.data(), decoded.data(), decoded.size(), 1);
  if (got < 0 || static_cast<std::size_t>(got) != bytes) {
    const char* inner = blosc_cbuffer_complib(stored.data());
    bad_input(path, "data that Blosc decodes",
              std::string("damaged ones of ") + (inner != nullptr ? inner : "no codec"));
  }
  return decoded;
}

}  // namespace isoweave
