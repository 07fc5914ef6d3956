#include "volume/packed_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "files/header_text.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

// The most bytes that a file can hold once it is inflated.
std::uint64_t most_bytes(const InputFile& stored) {
  constexpr std::uint64_t kLargest = std::numeric_limits<std::int64_t>::max();
  return std::min(stored.size(), kLargest / kDeflateRatio) * kDeflateRatio;
}

}  // namespace

bool is_gzip(std::string_view head) { return head.starts_with("\x1f\x8b"); }

FilePtr unpacked(const FilePtr& file, std::string_view wanted) {
  return is_gzip(file->head(2)) ? std::make_shared<PackedFile>(file, wanted) : file;
}

PackedFile::PackedFile(const FilePtr& stored, std::string_view wanted)
    : InputFile(stored->path(), most_bytes(*stored)), from_start_([stored] {
        return std::make_unique<InflateStream>(std::make_unique<FileStream>(stored, 0, stored->size()), stored->path());
      }) {
  read_head();
  if (head_.empty()) bad_input(path(), wanted, "an empty file in gzip");
}

PackedFile::PackedFile(const std::string& path, std::uint64_t bytes, Opener open)
    : InputFile(path, bytes), from_start_(std::move(open)), is_size_said_(true) {
  read_head();
}

void PackedFile::read_head() {
  stream_ = from_start_();
  head_.resize(kLargestHeader);
  head_.resize(stream_->read(std::as_writable_bytes(std::span(head_))));
  position_ = head_.size();
  whole_ = ended_ = head_.size() < kLargestHeader;
  if (whole_) set_size(head_.size());
}

std::uint64_t PackedFile::exact_size() const {
  if (!knows_size()) {
    set_size(from_start_()->skip(std::numeric_limits<std::uint64_t>::max()));
    ended_ = true;
  }
  return size();
}

// Brings the stream to `offset`; false when the end comes before.
bool PackedFile::reach(std::uint64_t offset) const {
  if (ended_ && offset >= size()) return false;
  if (offset < position_) {
    stream_ = from_start_();
    position_ = 0;
  }
  position_ += stream_->skip(offset - position_);
  return position_ == offset;
}

std::size_t PackedFile::read_at(std::uint64_t offset, std::span<std::byte> out) const {
  std::size_t done = 0;
  if (offset < head_.size()) {
    done = std::min<std::size_t>(out.size(), head_.size() - static_cast<std::size_t>(offset));
    std::memcpy(out.data(), head_.data() + offset, done);
  }
  if (whole_ || done == out.size()) return done;
  if (reach(offset + done)) {
    const std::size_t got = stream_->read(out.subspan(done));
    position_ += got;
    done += got;
  }
  if (done < out.size() && !ended_) {
    set_size(position_);
    ended_ = true;
  }
  return done;
}

void PackedFile::check_end(std::uint64_t offset) const {
  // Much may follow the wanted part of a file, such as further volumes. It is not inflated for the sake of a sum.
  std::array<std::byte, 64 * 1024> behind;
  if (!ended_ && offset >= position_) read_at(offset, behind);
}

}  // namespace isoweave
