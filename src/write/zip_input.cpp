#include "write/zip_input.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

#include "write/zip_archive.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr std::uint64_t kMost32 = 0xffffffffU;
constexpr std::uint64_t kEndBytes = 22, kLocatorBytes = 20;

constexpr std::uint64_t kMost16 = 0xffffU;
constexpr std::uint32_t kEndMark = 0x06054b50;

std::uint64_t next_number(MeshInput& input, std::size_t bytes) {
  std::array<std::byte, 8> buffer{};
  input.read(std::span(buffer).first(bytes));
  std::uint64_t value = 0;
  for (std::size_t n = buffer.size(); n-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(buffer[n]);
  return value;
}

// Moves behind the mark of the last record, which a comment of up to 65,535 bytes may follow.
void move_to_end_record(MeshInput& input) {
  const std::uint64_t size = input.size();
  const std::uint64_t tail = std::min(size, kEndBytes + kMost16);
  input.move_to(size - tail);
  std::vector<std::byte> bytes(static_cast<std::size_t>(tail));
  input.read(bytes);
  for (std::uint64_t at = tail < kEndBytes ? 0 : tail - kEndBytes + 1; at-- > 0;) {
    const auto byte = [&](std::uint64_t n) { return std::to_integer<std::uint32_t>(bytes[at + n]); };
    const std::uint32_t mark = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
    const std::uint64_t comment = byte(kEndBytes - 2) | byte(kEndBytes - 1) << 8;
    if (mark != kEndMark || at + kEndBytes + comment != tail) continue;
    return input.move_to(size - tail + at + 4);
  }
  input.fail("truncated: expected the end of a zip archive, found other data");
}

struct ZipDirectory {
  std::uint64_t offset = 0, entries = 0;
};

// From the last record, or the one of 64 bits that it stands for.
ZipDirectory find_directory(MeshInput& input) {
  move_to_end_record(input);
  const std::uint64_t end = input.size() - input.remaining() - 4;
  ZipDirectory directory;
  input.skip(6);
  directory.entries = next_number(input, 2);
  input.skip(4);
  directory.offset = next_number(input, 4);
  if (directory.offset != kMost32 && directory.entries != kMost16) return directory;
  if (end < kLocatorBytes) input.fail("truncated: expected a ZIP64 record");
  input.move_to(end - kLocatorBytes);
  if (next_number(input, 4) != 0x07064b50) input.fail("expected a ZIP64 record, found other data");
  input.skip(4);
  input.move_to(next_number(input, 8));
  if (next_number(input, 4) != 0x06064b50) input.fail("expected a ZIP64 record, found other data");
  input.skip(28);
  directory.entries = next_number(input, 8);
  input.skip(8);
  directory.offset = next_number(input, 8);
  return directory;
}

void take_wide_sizes(MeshInput& input, ZipRecord& record, std::uint64_t extra_bytes) {
  while (extra_bytes >= 4) {
    const std::uint64_t kind = next_number(input, 2);
    std::uint64_t size = next_number(input, 2);
    extra_bytes -= 4;
    if (size > extra_bytes) input.fail("expected extra fields of a zip entry, found other data");
    extra_bytes -= size;
    for (std::uint64_t* wide : {&record.bytes, &record.packed, &record.offset}) {
      if (kind != 1 || *wide != kMost32 || size < 8) continue;
      *wide = next_number(input, 8);
      size -= 8;
    }
    input.skip(size);
  }
  input.skip(extra_bytes);
}

ZipRecord read_record(MeshInput& input) {
  if (next_number(input, 4) != 0x02014b50) input.fail("expected an entry of a zip directory, found other data");
  ZipRecord record;
  input.skip(4);
  record.flags = next_number(input, 2);
  record.method = next_number(input, 2);
  input.skip(4);
  record.crc = next_number(input, 4);
  record.packed = next_number(input, 4);
  record.bytes = next_number(input, 4);
  const std::uint64_t name_bytes = next_number(input, 2);
  const std::uint64_t extra_bytes = next_number(input, 2);
  const std::uint64_t comment_bytes = next_number(input, 2);
  input.skip(8);
  record.offset = next_number(input, 4);
  record.name.resize(static_cast<std::size_t>(name_bytes));
  input.read(std::as_writable_bytes(std::span(record.name)));
  take_wide_sizes(input, record, extra_bytes);
  input.skip(comment_bytes);
  return record;
}

}  // namespace

struct ZipText::Inflater {
  Inflater() {
    constexpr int kRawBits = -15;
    if (::inflateInit2(&stream, kRawBits) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { ::inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  z_stream stream{};
  bool ended = false;
};

std::vector<ZipRecord> read_zip_directory(MeshInput& input) {
  const ZipDirectory directory = find_directory(input);
  input.move_to(directory.offset);
  std::vector<ZipRecord> records;
  for (std::uint64_t n = 0; n < directory.entries; ++n) records.push_back(read_record(input));
  return records;
}

ZipText::ZipText(MeshInput& input, const ZipRecord& record) : input_(input), record_(record) {
  open_entry();
  packed_text_.resize(kBufferBytes);
  text_.resize(kBufferBytes);
  packed_left_ = record_.packed;
  left_ = record_.bytes;
}

ZipText::~ZipText() = default;

void ZipText::open_entry() {
  if ((record_.flags & 1U) != 0 || (record_.method != 0 && record_.method != 8)) {
    input_.fail("expected '" + record_.name + "' stored or deflated, found it packed otherwise");
  }
  input_.move_to(record_.offset);
  if (next_number(input_, 4) != 0x04034b50) input_.fail("expected an entry of a zip archive, found other data");
  input_.skip(22);
  const std::uint64_t name_bytes = next_number(input_, 2);
  const std::uint64_t extra_bytes = next_number(input_, 2);
  input_.skip(name_bytes + extra_bytes);
  if (record_.packed > input_.remaining() || (record_.method == 0 && record_.packed != record_.bytes)) {
    input_.fail("truncated: expected " + std::to_string(record_.packed) + " bytes of the model, found " +
                std::to_string(input_.remaining()));
  }
}

bool ZipText::refill() {
  if (left_ == 0) {
    if (found_crc_ != record_.crc) input_.fail("is damaged: the checksum of the model is another");
    return false;
  }
  const std::size_t got = record_.method == 0 ? copy_some() : inflate_some();
  found_crc_ = zip_crc(static_cast<std::uint32_t>(found_crc_), std::string_view(text_).substr(0, got));
  left_ -= got;
  next_ = 0;
  filled_ = got;
  return true;
}

std::size_t ZipText::copy_some() {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(text_.size(), left_));
  input_.read(std::as_writable_bytes(std::span(text_)).first(count));
  return count;
}

std::size_t ZipText::inflate_some() {
  if (!inflater_) inflater_ = std::make_unique<Inflater>();
  z_stream& stream = inflater_->stream;
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(text_.size(), left_));
  stream.next_out = reinterpret_cast<Bytef*>(text_.data());  // NOLINT: zlib's bytes
  stream.avail_out = static_cast<uInt>(wanted);
  while (stream.avail_out == wanted) {
    if (stream.avail_in == 0) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(packed_text_.size(), packed_left_));
      if (count == 0) input_.fail("is damaged: the model ends " + std::to_string(left_) + " bytes early");
      input_.read(std::span(packed_text_).first(count));
      packed_left_ -= count;
      stream.next_in = reinterpret_cast<Bytef*>(packed_text_.data());  // NOLINT: zlib's bytes
      stream.avail_in = static_cast<uInt>(count);
    }
    const int result = ::inflate(&stream, Z_NO_FLUSH);
    const bool progressed = stream.avail_out < wanted || stream.avail_in == 0;
    if (result == Z_STREAM_END && stream.avail_out == wanted) {
      input_.fail("is damaged: the model ends " + std::to_string(left_) + " bytes early");
    }
    if ((result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) || !progressed) {
      input_.fail("is damaged: the model does not inflate");
    }
  }
  return wanted - stream.avail_out;
}

}  // namespace isoweave::mesh_io
