// The parts of a zip archive whose entries are named in ASCII: headers before entries and the directory behind them.
//
// The one entry that is written as a stream has its sizes and checksum put into its header afterwards. Sizes and
// offsets beyond 32 bits are in ZIP64 fields, which other archives do without.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace isoweave {

struct ZipEntry {
  std::string name;
  bool deflated = false;
  std::uint32_t crc = 0;
  std::uint64_t packed_bytes = 0;
  std::uint64_t bytes = 0;
  std::uint64_t offset = 0;  // of its header
};

// The header in front of an entry; its length depends on the name alone.
std::vector<std::byte> zip_header(const ZipEntry& entry);

// The directory that stands behind the last entry, from `offset` on.
std::vector<std::byte> zip_directory(std::span<const ZipEntry> entries, std::uint64_t offset);

// CRC-32 of text that follows text with the checksum `crc` (0: none).
std::uint32_t zip_crc(std::uint32_t crc, std::string_view text);

// Packs text as a block of a deflate stream. A block refers to nothing before it, so blocks can be packed one by one.
// Throws std::bad_alloc.
std::vector<std::byte> deflate_block(std::string_view text, bool last);

}  // namespace isoweave
