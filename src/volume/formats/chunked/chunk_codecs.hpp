// The codecs of chunks in Zarr and N5. What a chunk decodes to is bounded by what its array says of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isoweave {

enum class Codec : std::uint8_t {
  kDeflate,    // gzip or zlib
  kZstd,       //
  kBlosc,      //
  kLz4,        // one block behind its decoded size (numcodecs)
  kLz4Frames,  // blocks with headers of lz4-java (N5)
  kCrc32c      // four bytes behind the data
};

// The codec that Zarr knows by a name.
std::optional<Codec> zarr_codec(std::string_view name);

// How many bytes a chunk of `bytes` samples may have in the file: encoders add a little to what they cannot compress.
std::size_t most_stored(std::size_t bytes);

// Undoes codecs, the first of `codecs` first. Throws BadInput naming `path` unless that gives exactly `bytes` bytes.
std::vector<std::byte> decode_chunk(std::vector<std::byte> stored, std::span<const Codec> codecs, std::size_t bytes,
                                    const std::string& path);

// The same where it is not known how many bytes that gives: `most` at most. For codecs that pack no better than
// deflate.
std::vector<std::byte> undo_codecs(std::vector<std::byte> stored, std::span<const Codec> codecs, std::size_t most,
                                   const std::string& path);

// CRC-32C (Castagnoli).
std::uint32_t crc32c(std::span<const std::byte> bytes);

// The decoders of single codecs. Each returns the decoded bytes of `stored`, at most `most`, or throws BadInput naming
// `path`.
std::vector<std::byte> decode_zstd(std::span<const std::byte> stored, std::size_t most, const std::string& path);
std::vector<std::byte> decode_blosc(std::span<const std::byte> stored, std::size_t most, const std::string& path);
std::vector<std::byte> decode_lz4(std::span<const std::byte> stored, std::size_t most, const std::string& path);
std::vector<std::byte> decode_lz4_frames(std::span<const std::byte> stored, std::size_t most, const std::string& path);

}  // namespace isoweave
