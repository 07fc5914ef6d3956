// CRC-32 as zlib and PNG have it (polynomial 0x04c11db7, reflected), for files of our own, which must be readable
// without zlib. The library that unpacks a packed file finds the CRCs in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace isoweave {

// The CRC-32 of more bytes; that of none is 0.
std::uint32_t add_to_crc(std::uint32_t crc, std::span<const std::byte> bytes);

// The CRC-32 of a text from those of its two parts, of which the second one has so many bytes.
std::uint32_t join_crcs(std::uint32_t first, std::uint32_t second, std::uint64_t second_bytes);

}  // namespace isoweave
