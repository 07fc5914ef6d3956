#include "files/byte_stream.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <utility>
#include <vector>

namespace isoweave {
namespace {

constexpr std::size_t kBufferBytes = 64 * 1024;

}  // namespace

std::uint64_t ByteStream::skip(std::uint64_t count) {
  std::vector<std::byte> dropped(static_cast<std::size_t>(std::min<std::uint64_t>(count, kBufferBytes)));
  std::uint64_t done = 0;
  while (done < count) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count - done, dropped.size()));
    const std::size_t got = read(std::span(dropped).first(wanted));
    done += got;
    if (got < wanted) break;
  }
  return done;
}

FileStream::FileStream(FilePtr file, std::uint64_t begin, std::uint64_t end)
    : file_(std::move(file)), position_(std::min(begin, end)), end_(end) {}

std::size_t FileStream::read(std::span<std::byte> out) {
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), end_ - position_));
  const std::size_t got = file_->read_at(position_, out.first(wanted));
  // A file larger than this would push everything else out of the system's cache, and itself before it is read again.
  constexpr std::uint64_t kHuge = std::uint64_t{8} << 30;
  if (file_->size() > kHuge) file_->forget(position_, got);
  position_ += got;
  if (wanted < out.size()) file_->check_end(end_);
  return got;
}

std::uint64_t FileStream::skip(std::uint64_t count) {
  const std::uint64_t skipped = std::min(count, end_ - position_);
  position_ += skipped;
  return skipped;
}

struct InflateStream::State {
  explicit State(Form form) {
    constexpr int kZlibOrGzip = 15 + 32;
    constexpr int kRaw = -15;
    if (inflateInit2(&zlib, form == Form::kRaw ? kRaw : kZlibOrGzip) != Z_OK) throw std::bad_alloc();
  }
  ~State() { inflateEnd(&zlib); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  z_stream zlib{};
  std::array<std::byte, kBufferBytes> input;
  bool gzip = false;
  bool member_done = false;
};

InflateStream::InflateStream(std::unique_ptr<ByteStream> input, std::string path, Form form)
    : input_(std::move(input)), path_(std::move(path)), state_(std::make_unique<State>(form)) {
  refill();
  state_->gzip = form == Form::kZlibOrGzip && state_->zlib.avail_in > 0 && state_->input[0] == std::byte{0x1f};
}

InflateStream::~InflateStream() = default;

void InflateStream::refill() {
  if (state_->zlib.avail_in > 0) return;
  state_->zlib.avail_in = static_cast<uInt>(input_->read(state_->input));
  state_->zlib.next_in = reinterpret_cast<Bytef*>(state_->input.data());
}

// Whether no further member follows one that ended. Bytes that are not the start of a gzip member are padding.
bool InflateStream::at_end() {
  if (!state_->member_done) return false;
  refill();
  constexpr Bytef kGzipStart = 0x1f;
  if (!state_->gzip || state_->zlib.avail_in == 0 || *state_->zlib.next_in != kGzipStart) return true;
  if (inflateReset(&state_->zlib) != Z_OK) bad_input(path_, "the compressed data are corrupt");
  state_->member_done = false;
  return false;
}

void InflateStream::inflate_some() {
  refill();
  if (state_->zlib.avail_in == 0) bad_input(path_, "a complete compressed stream", "its end missing");
  const int result = inflate(&state_->zlib, Z_NO_FLUSH);
  if (result == Z_STREAM_END) {
    state_->member_done = true;
  } else if (result == Z_MEM_ERROR) {
    throw std::bad_alloc();
  } else if (result != Z_OK && result != Z_BUF_ERROR) {
    const char* reason = state_->zlib.msg != nullptr ? state_->zlib.msg : "unknown";
    bad_input(path_, std::string("the compressed data are corrupt: ") + reason);
  }
}

std::size_t InflateStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && !at_end()) {
    const std::size_t room = std::min<std::size_t>(out.size() - done, std::numeric_limits<uInt>::max());
    state_->zlib.next_out = reinterpret_cast<Bytef*>(out.data() + done);
    state_->zlib.avail_out = static_cast<uInt>(room);
    inflate_some();
    done += room - state_->zlib.avail_out;
  }
  return done;
}

std::size_t DecodedStream::read(std::span<std::byte> out) {
  if (decode_) bytes_ = std::exchange(decode_, nullptr)();
  const std::size_t step = std::min(out.size(), bytes_.size() - used_);
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(used_), step, out.begin());
  used_ += step;
  return step;
}

FileSequence::FileSequence(std::int64_t count, std::uint64_t bytes_each, Opener open, Namer name)
    : count_(count), bytes_each_(bytes_each), open_(std::move(open)), name_(std::move(name)) {}

bool FileSequence::open_current() {
  if (index_ >= count_) return false;
  if (!current_) {
    current_ = open_(index_);
    if (current_->skip(position_) < position_) bad_input(name_(index_), "the file is too short");
  }
  return true;
}

void FileSequence::advance(std::uint64_t bytes) {
  position_ += bytes;
  if (position_ < bytes_each_) return;
  position_ = 0;
  ++index_;
  current_.reset();
}

std::size_t FileSequence::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && open_current()) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(out.size() - done, bytes_each_ - position_));
    const std::size_t got = current_->read(out.subspan(done, wanted));
    if (got < wanted) {
      bad_input(name_(index_), std::to_string(bytes_each_) + " bytes of samples", std::to_string(position_ + got));
    }
    done += got;
    advance(got);
  }
  return done;
}

std::uint64_t FileSequence::skip(std::uint64_t count) {
  std::uint64_t done = 0;
  while (done < count && index_ < count_) {
    const std::uint64_t step = std::min(count - done, bytes_each_ - position_);
    // A file that is skipped whole need not be opened.
    if (current_ && step < bytes_each_ - position_ && current_->skip(step) < step) {
      bad_input(name_(index_), std::to_string(bytes_each_) + " bytes of samples", "fewer");
    }
    done += step;
    advance(step);
  }
  return done;
}

}  // namespace isoweave
