#include "files/zip_archive.hpp"

#include <zlib.h>

#include <new>
#include <string_view>

namespace isoweave {
namespace {

constexpr std::uint64_t kMost32 = 0xffffffffU;
constexpr std::uint16_t kZip64 = 1;         // kind of extra field
constexpr std::uint16_t kPadding = 0xd935;  // kind of extra field that holds nothing
constexpr std::uint16_t kDeflated = 8;
constexpr std::uint16_t kVersion = 20, kVersion64 = 45;
constexpr std::uint32_t kFirstOf1980 = 0x21;  // no clock: equal meshes make equal files

class Bytes {
 public:
  void word16(std::uint64_t value) { put(value, 2); }
  void word32(std::uint64_t value) { put(value, 4); }
  void word64(std::uint64_t value) { put(value, 8); }
  void text(std::string_view text) {
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }
  std::size_t size() const { return bytes_.size(); }

 private:
  void put(std::uint64_t value, int count) {
    for (int n = 0; n < count; ++n) bytes_.push_back(static_cast<std::byte>(value >> (8 * n) & 0xffU));
  }

  std::vector<std::byte> bytes_;
};

bool is_large(const ZipEntry& entry) { return entry.bytes >= kMost32 || entry.packed_bytes >= kMost32; }

std::uint64_t shown(std::uint64_t number, bool large) { return large ? kMost32 : number; }

// From the version to the extra field's length, which both kinds of headers share.
void put_common(Bytes& out, const ZipEntry& entry, bool large, bool zip64, std::size_t extra_bytes) {
  out.word16(zip64 ? kVersion64 : kVersion);
  out.word16(0);
  out.word16(entry.deflated ? kDeflated : 0);
  out.word16(0);
  out.word16(kFirstOf1980);
  out.word32(entry.crc);
  out.word32(shown(entry.packed_bytes, large));
  out.word32(shown(entry.bytes, large));
  out.word16(entry.name.size());
  out.word16(extra_bytes);
}

}  // namespace

std::vector<std::byte> zip_header(const ZipEntry& entry) {
  const bool large = is_large(entry);
  Bytes out;
  out.word32(0x04034b50);
  put_common(out, entry, large, large, 20);
  out.text(entry.name);
  // A place for sizes of 64 bits, needed or not.
  out.word16(large ? kZip64 : kPadding);
  out.word16(16);
  out.word64(large ? entry.bytes : 0);
  out.word64(large ? entry.packed_bytes : 0);
  return out.take();
}

std::vector<std::byte> zip_directory(std::span<const ZipEntry> entries, std::uint64_t offset) {
  Bytes out;
  for (const ZipEntry& entry : entries) {
    const bool large = is_large(entry);
    const bool far = entry.offset >= kMost32;
    const std::size_t field = (large ? 16U : 0U) + (far ? 8U : 0U);
    out.word32(0x02014b50);
    out.word16(kVersion64);  // made by
    put_common(out, entry, large, field > 0, field > 0 ? 4 + field : 0);
    out.word16(0);  // comment
    out.word16(0);  // disk
    out.word16(0);  // attributes
    out.word32(0);
    out.word32(shown(entry.offset, far));
    out.text(entry.name);
    if (field == 0) continue;
    out.word16(kZip64);
    out.word16(field);
    if (large) out.word64(entry.bytes);
    if (large) out.word64(entry.packed_bytes);
    if (far) out.word64(entry.offset);
  }
  const std::uint64_t bytes = out.size();
  if (offset >= kMost32) {
    out.word32(0x06064b50);
    out.word64(44);  // bytes of this record that follow
    out.word16(kVersion64);
    out.word16(kVersion64);
    out.word32(0);
    out.word32(0);
    out.word64(entries.size());
    out.word64(entries.size());
    out.word64(bytes);
    out.word64(offset);
    out.word32(0x07064b50);
    out.word32(0);
    out.word64(offset + bytes);
    out.word32(1);
  }
  out.word32(0x06054b50);
  out.word32(0);
  out.word16(entries.size());
  out.word16(entries.size());
  out.word32(bytes);
  out.word32(shown(offset, offset >= kMost32));
  out.word16(0);
  return out.take();
}

std::uint32_t zip_crc(std::uint32_t crc, std::string_view text) {
  return static_cast<std::uint32_t>(
      ::crc32_z(crc, reinterpret_cast<const Bytef*>(text.data()), text.size()));  // NOLINT: zlib's bytes
}

std::vector<std::byte> deflate_block(std::string_view text, bool last) {
  constexpr int kFast = 1, kRawBits = -15, kMemory = 9;
  z_stream stream{};
  if (::deflateInit2(&stream, kFast, Z_DEFLATED, kRawBits, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::vector<std::byte> packed(::deflateBound(&stream, text.size()) + 16);
  stream.next_in = reinterpret_cast<const Bytef*>(text.data());  // NOLINT: zlib's bytes
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());  // NOLINT: zlib's bytes
  stream.avail_out = static_cast<uInt>(packed.size());
  ::deflate(&stream, last ? Z_FINISH : Z_FULL_FLUSH);
  packed.erase(packed.begin() + static_cast<std::ptrdiff_t>(stream.total_out), packed.end());
  ::deflateEnd(&stream);
  return packed;
}

}  // namespace isoweave
