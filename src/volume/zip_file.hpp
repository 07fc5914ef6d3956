// Entries of a zip archive, as 3MF and NPZ are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "files/byte_stream.hpp"
#include "files/input_file.hpp"

namespace isoweave {

// An entry as the directory of the archive describes it.
struct ZipRecord {
  std::string name;
  std::uint64_t flags = 0, method = 0, crc = 0, packed = 0, bytes = 0, offset = 0;
};

// Whether the first bytes of a file are those of an archive, which may be empty.
bool is_zip(std::string_view head);

// The name of the entry that an archive begins with, by its first bytes; empty where it has none.
std::string_view first_zip_name(std::string_view head);

// The directory, which may have a comment behind it. The file is to be one that jumps.
std::vector<ZipRecord> read_zip_directory(const FilePtr& file);

// The bytes of an entry, stored or deflated. Never gives more than the directory says, and checks their number and
// their CRC-32 at the end.
std::unique_ptr<ByteStream> open_zip_entry(const FilePtr& file, const ZipRecord& record);

}  // namespace isoweave
