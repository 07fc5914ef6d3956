#include "volume/zip_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "files/quoted.hpp"
#include "parallel/size.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kMost16 = 0xffffU;
constexpr std::uint64_t kMost32 = 0xffffffffU;
constexpr std::uint64_t kEndBytes = 22, kLocatorBytes = 20, kEnd64Bytes = 56, kRecordBytes = 46, kHeaderBytes = 30;
constexpr std::uint64_t kEndMark = 0x06054b50, kLocatorMark = 0x07064b50, kEnd64Mark = 0x06064b50;
constexpr std::uint64_t kRecordMark = 0x02014b50, kHeaderMark = 0x04034b50;
constexpr std::uint64_t kStored = 0, kDeflated = 8;

// A stretch of the archive, in which numbers have the least significant byte first.
class ZipBytes {
 public:
  ZipBytes(const InputFile& file, std::uint64_t at, std::uint64_t count) {
    const std::uint64_t left = file.size() - std::min(at, file.size());
    if (count > left) {
      bad_input(file.path(), std::to_string(count) + " bytes of a zip archive from byte " + std::to_string(at) + " on",
                std::to_string(left));
    }
    bytes_.resize(to_size(count));
    if (file.read_at(at, bytes_) < bytes_.size()) bad_input(file.path(), "a whole zip archive", "a part of one");
  }

  std::uint64_t size() const { return bytes_.size(); }

  std::uint64_t number(std::uint64_t at, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t n = count; n-- > 0;) {
      value = value << 8 | std::to_integer<std::uint64_t>(bytes_[static_cast<std::size_t>(at) + n]);
    }
    return value;
  }

  std::string text(std::uint64_t at, std::uint64_t count) const {
    std::string text;
    for (std::uint64_t n = 0; n < count; ++n) text += std::to_integer<char>(bytes_[static_cast<std::size_t>(at + n)]);
    return text;
  }

 private:
  std::vector<std::byte> bytes_;
};

// Finds the beginning of the last record, which a comment of up to 65,535 bytes may follow.
std::uint64_t end_record(const InputFile& file) {
  const std::uint64_t count = std::min(file.size(), kEndBytes + kMost16);
  const ZipBytes tail(file, file.size() - count, count);
  for (std::uint64_t at = count < kEndBytes ? 0 : count - kEndBytes + 1; at-- > 0;) {
    if (tail.number(at, 4) != kEndMark) continue;
    if (at + kEndBytes + tail.number(at + kEndBytes - 2, 2) == count) return file.size() - count + at;
  }
  bad_input(file.path(), "the end of a zip archive", "other data, or a file that is cut off");
}

struct ZipDirectory {
  std::uint64_t offset = 0, entries = 0;
};

// From the last record, or the one of 64 bits that it stands for.
ZipDirectory find_directory(const InputFile& file) {
  const std::uint64_t end = end_record(file);
  const ZipBytes record(file, end, kEndBytes);
  const ZipDirectory directory{record.number(16, 4), record.number(10, 2)};
  if (directory.offset != kMost32 && directory.entries != kMost16) return directory;
  const bool has_locator = end >= kLocatorBytes;
  const ZipBytes locator(file, has_locator ? end - kLocatorBytes : 0, kLocatorBytes);
  if (!has_locator || locator.number(0, 4) != kLocatorMark) bad_input(file.path(), "a ZIP64 record", "other data");
  const ZipBytes wide(file, locator.number(8, 8), kEnd64Bytes);
  if (wide.number(0, 4) != kEnd64Mark) bad_input(file.path(), "a ZIP64 record", "other data");
  return {wide.number(48, 8), wide.number(32, 8)};
}

// Sizes and places beyond 32 bits stand in an extra field, those of them that do not fit, one after another.
void take_wide_sizes(const InputFile& file, ZipRecord& record, const ZipBytes& extra, std::uint64_t at) {
  while (extra.size() - at >= 4) {
    const bool wide = extra.number(at, 2) == 1;
    const std::uint64_t end = at + 4 + extra.number(at + 2, 2);
    if (end > extra.size()) bad_input(file.path(), "extra fields of a zip entry", "other data");
    at += 4;
    for (std::uint64_t* number : {&record.bytes, &record.packed, &record.offset}) {
      if (!wide || *number != kMost32 || end - at < 8) continue;
      *number = extra.number(at, 8);
      at += 8;
    }
    at = end;
  }
}

// The entry of the directory at a place, which moves behind it.
ZipRecord read_record(const InputFile& file, std::uint64_t& at) {
  const ZipBytes fixed(file, at, kRecordBytes);
  if (fixed.number(0, 4) != kRecordMark) bad_input(file.path(), "an entry of a zip directory", "other data");
  ZipRecord record;
  record.flags = fixed.number(8, 2);
  record.method = fixed.number(10, 2);
  record.crc = fixed.number(16, 4);
  record.packed = fixed.number(20, 4);
  record.bytes = fixed.number(24, 4);
  record.offset = fixed.number(42, 4);
  const std::uint64_t name = fixed.number(28, 2);
  const ZipBytes more(file, at + kRecordBytes, name + fixed.number(30, 2));
  record.name = more.text(0, name);
  take_wide_sizes(file, record, more, name);
  at += kRecordBytes + more.size() + fixed.number(32, 2);
  return record;
}

// The bytes of an entry, as many as the directory says and of the sum that it says.
class ZipEntryStream final : public ByteStream {
 public:
  ZipEntryStream(std::unique_ptr<ByteStream> bytes, const ZipRecord& record, std::string path)
      : bytes_(std::move(bytes)), record_(record), left_(record.bytes), path_(std::move(path)) {}

  std::size_t read(std::span<std::byte> out) override {
    const std::span<std::byte> wanted = out.first(static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), left_)));
    if (wanted.empty()) return 0;
    if (bytes_->read(wanted) < wanted.size()) damaged("its end missing");
    left_ -= wanted.size();
    sum_ = ::crc32_z(sum_, reinterpret_cast<const Bytef*>(wanted.data()), wanted.size());
    if (left_ == 0 && sum_ != record_.crc) damaged("another checksum");
    return wanted.size();
  }

 private:
  [[noreturn]] void damaged(std::string_view found) const {
    bad_input(path_, in_quotes(record_.name) + " as the directory of the archive has it", found);
  }

  std::unique_ptr<ByteStream> bytes_;
  ZipRecord record_;
  std::uint64_t left_;
  std::string path_;
  uLong sum_ = 0;
};

}  // namespace

bool is_zip(std::string_view head) { return head.starts_with("PK\x03\x04") || head.starts_with("PK\x05\x06"); }

std::string_view first_zip_name(std::string_view head) {
  constexpr std::size_t kLengthPlace = 26;
  if (head.size() <= kHeaderBytes) return {};
  return head.substr(kHeaderBytes, static_cast<unsigned char>(head[kLengthPlace]));
}

std::vector<ZipRecord> read_zip_directory(const FilePtr& file) {
  const ZipDirectory directory = find_directory(*file);
  std::uint64_t at = directory.offset;
  std::vector<ZipRecord> records;
  for (std::uint64_t n = 0; n < directory.entries; ++n) records.push_back(read_record(*file, at));
  return records;
}

std::unique_ptr<ByteStream> open_zip_entry(const FilePtr& file, const ZipRecord& record) {
  const std::string& path = file->path();
  if ((record.flags & 1U) != 0 || (record.method != kStored && record.method != kDeflated)) {
    bad_input(path, in_quotes(record.name) + " stored or deflated", "it packed otherwise");
  }
  const ZipBytes header(*file, record.offset, kHeaderBytes);
  if (header.number(0, 4) != kHeaderMark) bad_input(path, "an entry of a zip archive", "other data");
  const std::uint64_t begin = record.offset + kHeaderBytes + header.number(26, 2) + header.number(28, 2);
  const std::uint64_t left = file->size() - std::min(begin, file->size());
  const bool stored = record.method == kStored;
  if (record.packed > left || (stored && record.packed != record.bytes)) {
    bad_input(path, std::to_string(record.bytes) + " bytes of " + in_quotes(record.name), std::to_string(left));
  }
  check_plausible(path, record.bytes, record.packed, stored ? 1 : kDeflateRatio);
  std::unique_ptr<ByteStream> bytes = std::make_unique<FileStream>(file, begin, begin + record.packed);
  if (!stored) bytes = std::make_unique<InflateStream>(std::move(bytes), path, InflateStream::Form::kRaw);
  return std::make_unique<ZipEntryStream>(std::move(bytes), record, path);
}

}  // namespace isoweave
