#include "write/zip_input.hpp"

#include <zlib.h>

#include <algorithm>
#include <new>

#include "write/zip_archive.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr std::uint64_t kMost32 = 0xffffffffU;
constexpr std::uint64_t kEndBytes = 22, kLocatorBytes = 20;

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

ZipText::ZipText(MeshInput& input, std::string_view ending) : input_(input) {
  find_entry(ending);
  open_entry();
  packed_text_.resize(kBufferBytes);
  text_.resize(kBufferBytes);
  packed_left_ = packed_;
  left_ = bytes_;
}

ZipText::~ZipText() = default;

std::uint64_t ZipText::next_number(int bytes) {
  std::array<std::byte, 8> buffer{};
  input_.read(std::span(buffer).first(static_cast<std::size_t>(bytes)));
  std::uint64_t value = 0;
  for (std::size_t n = buffer.size(); n-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(buffer[n]);
  return value;
}

void ZipText::find_entry(std::string_view ending) {
  std::uint64_t offset = 0;
  std::uint64_t entries = 0;
  find_directory(offset, entries);
  input_.move_to(offset);
  for (std::uint64_t n = 0; n < entries; ++n) {
    if (read_entry(ending)) return;
  }
  input_.fail("expected an entry '*" + std::string(ending) + "' in the archive, found none");
}

// From the last record, which has no comment behind it, or the one of 64 bits that it stands for.
void ZipText::find_directory(std::uint64_t& offset, std::uint64_t& entries) {
  if (input_.size() < kEndBytes) input_.fail("truncated: expected the end of a zip archive");
  input_.move_to(input_.size() - kEndBytes);
  if (next_number(4) != 0x06054b50) input_.fail("truncated: expected the end of a zip archive, found other data");
  input_.skip(6);
  entries = next_number(2);
  input_.skip(4);
  offset = next_number(4);
  if (offset != kMost32) return;
  if (input_.size() < kEndBytes + kLocatorBytes) input_.fail("truncated: expected a ZIP64 record");
  input_.move_to(input_.size() - kEndBytes - kLocatorBytes);
  if (next_number(4) != 0x07064b50) input_.fail("expected a ZIP64 record, found other data");
  input_.skip(4);
  input_.move_to(next_number(8));
  if (next_number(4) != 0x06064b50) input_.fail("expected a ZIP64 record, found other data");
  input_.skip(28);
  entries = next_number(8);
  input_.skip(8);
  offset = next_number(8);
}

// One entry of the directory; whether it is the one.
bool ZipText::read_entry(std::string_view ending) {
  if (next_number(4) != 0x02014b50) input_.fail("expected an entry of a zip directory, found other data");
  input_.skip(4);
  const std::uint64_t flags = next_number(2);
  method_ = next_number(2);
  input_.skip(4);
  crc_ = next_number(4);
  packed_ = next_number(4);
  bytes_ = next_number(4);
  const std::uint64_t name_bytes = next_number(2);
  const std::uint64_t extra_bytes = next_number(2);
  const std::uint64_t comment_bytes = next_number(2);
  input_.skip(8);
  offset_ = next_number(4);
  std::string name(static_cast<std::size_t>(name_bytes), '\0');
  input_.read(std::as_writable_bytes(std::span(name)));
  take_wide_sizes(extra_bytes);
  input_.skip(comment_bytes);
  if (!name.ends_with(ending)) return false;
  if ((flags & 1U) != 0 || (method_ != 0 && method_ != 8)) {
    input_.fail("expected '" + name + "' stored or deflated, found it packed otherwise");
  }
  return true;
}

void ZipText::take_wide_sizes(std::uint64_t extra_bytes) {
  while (extra_bytes >= 4) {
    const std::uint64_t kind = next_number(2);
    std::uint64_t size = next_number(2);
    extra_bytes -= 4;
    if (size > extra_bytes) input_.fail("expected extra fields of a zip entry, found other data");
    extra_bytes -= size;
    for (std::uint64_t* wide : {&bytes_, &packed_, &offset_}) {
      if (kind != 1 || *wide != kMost32 || size < 8) continue;
      *wide = next_number(8);
      size -= 8;
    }
    input_.skip(size);
  }
  input_.skip(extra_bytes);
}

void ZipText::open_entry() {
  input_.move_to(offset_);
  if (next_number(4) != 0x04034b50) input_.fail("expected an entry of a zip archive, found other data");
  input_.skip(22);
  const std::uint64_t name_bytes = next_number(2);
  const std::uint64_t extra_bytes = next_number(2);
  input_.skip(name_bytes + extra_bytes);
  if (packed_ > input_.remaining() || (method_ == 0 && packed_ != bytes_)) {
    input_.fail("truncated: expected " + std::to_string(packed_) + " bytes of the model, found " +
                std::to_string(input_.remaining()));
  }
}

bool ZipText::refill() {
  if (left_ == 0) {
    if (found_crc_ != crc_) input_.fail("is damaged: the checksum of the model is another");
    return false;
  }
  const std::size_t got = method_ == 0 ? copy_some() : inflate_some();
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
