// LZMA blocks of VTK files, each an .xz stream.
#include <lzma.h>

#include <string>
#include <utility>
#include <vector>

#include "parallel/size.hpp"
#include "volume/formats/vtk/vtk_streams.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

std::vector<std::byte> unpacked_lzma(ByteStream& input, std::uint64_t stored, std::uint64_t bytes,
                                     const std::string& path) {
  constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 28;
  std::vector<std::byte> packed(to_size(stored));
  std::vector<std::byte> out(to_size(bytes));
  std::uint64_t memory = kMostMemory;
  std::size_t read = 0;
  std::size_t written = 0;
  const bool whole = input.read(packed) == packed.size();
  const lzma_ret result =
      ::lzma_stream_buffer_decode(&memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()), &read,
                                  packed.size(), reinterpret_cast<std::uint8_t*>(out.data()), &written, out.size());
  if (!whole || result != LZMA_OK || written != out.size()) {
    bad_input(path, "LZMA blocks of " + std::to_string(bytes) + " bytes", "damaged data");
  }
  return out;
}

}  // namespace

std::unique_ptr<ByteStream> open_lzma_block(std::unique_ptr<ByteStream> input, std::uint64_t stored,
                                            std::uint64_t bytes, const std::string& path) {
  check_plausible(path, bytes, stored, kLzmaRatio);
  const std::shared_ptr<ByteStream> source = std::move(input);
  return std::make_unique<DecodedStream>([=] { return unpacked_lzma(*source, stored, bytes, path); });
}

}  // namespace isoweave
