// LZ4 blocks of VTK files.
#include <lz4.h>

#include <string>
#include <utility>
#include <vector>

#include "volume/formats/vtk/vtk_streams.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

// A stored byte adds at most 255 to the length of a match.
constexpr std::uint64_t kLz4Ratio = 255;

std::vector<std::byte> unpacked_lz4(ByteStream& input, std::uint64_t stored, std::uint64_t bytes,
                                    const std::string& path) {
  std::vector<std::byte> packed(static_cast<std::size_t>(stored));
  std::vector<std::byte> out(static_cast<std::size_t>(bytes));
  const bool whole = input.read(packed) == packed.size();
  const int got = LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()), reinterpret_cast<char*>(out.data()),
                                      static_cast<int>(packed.size()), static_cast<int>(out.size()));
  if (!whole || got != static_cast<int>(out.size())) {
    bad_input(path, "LZ4 blocks of " + std::to_string(bytes) + " bytes", "damaged data");
  }
  return out;
}

}  // namespace

std::unique_ptr<ByteStream> open_lz4_block(std::unique_ptr<ByteStream> input, std::uint64_t stored, std::uint64_t bytes,
                                           const std::string& path) {
  check_plausible(path, bytes, stored, kLz4Ratio);
  if (stored > LZ4_MAX_INPUT_SIZE || bytes > LZ4_MAX_INPUT_SIZE) {
    bad_input(path, "LZ4 blocks of less than 2 GB", std::to_string(bytes) + " bytes");
  }
  const std::shared_ptr<ByteStream> source = std::move(input);
  return std::make_unique<DecodedStream>([=] { return unpacked_lz4(*source, stored, bytes, path); });
}

}  // namespace isoweave
