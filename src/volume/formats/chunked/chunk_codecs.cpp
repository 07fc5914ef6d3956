#include "volume/formats/chunked/chunk_codecs.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include "files/byte_stream.hpp"
#include "files/input_file.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

std::vector<std::byte> decode_deflate(std::vector<std::byte> stored, std::size_t most, const std::string& path) {
  check_plausible(path, most, stored.size(), kDeflateRatio);
  auto input = std::make_unique<DecodedStream>([&stored] { return std::move(stored); });
  InflateStream stream(std::move(input), path);
  std::vector<std::byte> decoded(most);
  decoded.resize(stream.read(decoded));
  // One byte more makes the stream check its sum.
  std::array<std::byte, 1> beyond;
  if (stream.read(beyond) > 0) bad_input(path, "at most " + std::to_string(most) + " bytes once inflated", "more");
  return decoded;
}

std::vector<std::byte> checked_crc32c(std::vector<std::byte> stored, const std::string& path) {
  std::uint32_t expected = 0;
  if (stored.size() < sizeof expected) bad_input(path, "a checksum of 4 bytes", std::to_string(stored.size()));
  const std::size_t bytes = stored.size() - sizeof expected;
  std::memcpy(&expected, stored.data() + bytes, sizeof expected);
  stored.resize(bytes);
  if (crc32c(stored) != expected) bad_input(path, "data of their CRC-32C", "damaged data");
  return stored;
}

std::vector<std::byte> decode(Codec codec, std::vector<std::byte> stored, std::size_t most, const std::string& path) {
  switch (codec) {
    case Codec::kDeflate:
      return decode_deflate(std::move(stored), most, path);
    case Codec::kZstd:
      return decode_zstd(stored, most, path);
    case Codec::kBlosc:
      return decode_blosc(stored, most, path);
    case Codec::kLz4:
      return decode_lz4(stored, most, path);
    case Codec::kLz4Frames:
      return decode_lz4_frames(stored, most, path);
    case Codec::kCrc32c:
      break;
  }
  return checked_crc32c(std::move(stored), path);
}

}  // namespace

std::optional<Codec> zarr_codec(std::string_view name) {
  if (constexpr std::string_view kOwn = "numcodecs."; name.starts_with(kOwn)) name.remove_prefix(kOwn.size());
  static constexpr std::array<std::pair<std::string_view, Codec>, 6> kNames{{{"gzip", Codec::kDeflate},
                                                                             {"zlib", Codec::kDeflate},
                                                                             {"zstd", Codec::kZstd},
                                                                             {"blosc", Codec::kBlosc},
                                                                             {"lz4", Codec::kLz4},
                                                                             {"crc32c", Codec::kCrc32c}}};
  for (const auto& [known, codec] : kNames) {
    if (known == name) return codec;
  }
  return std::nullopt;
}

std::size_t most_stored(std::size_t bytes) {
  constexpr std::size_t kFrame = 4096;
  return bytes + bytes / 64 + kFrame;
}

std::vector<std::byte> undo_codecs(std::vector<std::byte> stored, std::span<const Codec> codecs, std::size_t most,
                                   const std::string& path) {
  for (const Codec codec : codecs) {
    const std::size_t plausible = std::min<std::uint64_t>(most, stored.size() * kDeflateRatio);
    stored = decode(codec, std::move(stored), plausible, path);
  }
  return stored;
}

std::vector<std::byte> decode_chunk(std::vector<std::byte> stored, std::span<const Codec> codecs, std::size_t bytes,
                                    const std::string& path) {
  for (std::size_t n = 0; n < codecs.size(); ++n) {
    const bool last = n + 1 == codecs.size();
    stored = decode(codecs[n], std::move(stored), last ? bytes : most_stored(bytes), path);
  }
  if (stored.size() != bytes) {
    bad_input(path, "a chunk of " + std::to_string(bytes) + " bytes", std::to_string(stored.size()));
  }
  return stored;
}

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    constexpr std::uint32_t kPolynomial = 0x82f63b78;  // reflected
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t n = 0; n < table.size(); ++n) {
      std::uint32_t value = n;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? kPolynomial : 0);
      table.at(n) = value;
    }
    return table;
  }();
  std::uint32_t sum = ~std::uint32_t{0};
  for (const std::byte byte : bytes) sum = (sum >> 8) ^ kTable[(sum ^ std::to_integer<std::uint32_t>(byte)) & 0xff];
  return ~sum;
}

}  // namespace isoweave
