#include "volume/picked_stream.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace isoweave {

PickedStream::PickedStream(std::unique_ptr<ByteStream> all, const Pattern& pattern, std::uint64_t bytes)
    : all_(std::move(all)), pattern_(pattern), bytes_(bytes) {}

// Bytes from `from` on, up to `count` of them; none at the end of the stream. Calls never go back.
std::span<const std::byte> PickedStream::fetch(std::uint64_t from, std::size_t count) {
  constexpr std::size_t kBuffer = std::size_t{1} << 16;
  if (from >= behind_) {
    if (all_->skip(from - behind_) < from - behind_) return {};
    buffer_.resize(kBuffer);
    buffer_.resize(all_->read(buffer_));
    behind_ = from + buffer_.size();
  }
  const std::size_t left = static_cast<std::size_t>(behind_ - from);
  return std::span(buffer_).last(left).first(std::min(left, count));
}

std::size_t PickedStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && position_ < bytes_) {
    const std::uint64_t within = position_ % pattern_.block;
    const std::uint64_t first = (position_ / pattern_.block * pattern_.count + pattern_.index) * pattern_.block;
    const std::uint64_t wanted = std::min<std::uint64_t>(pattern_.block - within, out.size() - done);
    const auto got = fetch(first + within, static_cast<std::size_t>(std::min(wanted, bytes_ - position_)));
    if (got.empty()) break;
    std::memcpy(out.data() + done, got.data(), got.size());
    done += got.size();
    position_ += got.size();
  }
  return done;
}

std::uint64_t PickedStream::skip(std::uint64_t count) {
  const std::uint64_t skipped = std::min(count, bytes_ - position_);
  position_ += skipped;
  return skipped;
}

std::unique_ptr<ByteStream> pick_volume(std::unique_ptr<ByteStream> all, const std::vector<ArrayAxis>& axes,
                                        const AxisChoice& choice, std::size_t sample_bytes, std::string_view path) {
  const auto& [i, j, k] = choice.axis;
  if (j > i || (k != kNoAxis && k > j)) {
    bad_input(path, "slices that lie behind one another", "an axis of slices that runs faster than rows or columns");
  }
  std::uint64_t left = checked_bytes_of(axes, sample_bytes, path);
  std::uint64_t block = left;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    const auto count = static_cast<std::uint64_t>(axes[n].size);
    block /= count;
    if (count == 1 || n == i || n == j || n == k) continue;
    left /= count;
    const PickedStream::Pattern pattern{block, count, static_cast<std::uint64_t>(choice.at[n])};
    all = std::make_unique<PickedStream>(std::move(all), pattern, left);
  }
  return all;
}

std::uint64_t picked_extent(const std::vector<ArrayAxis>& axes, const AxisChoice& choice, std::size_t sample_bytes,
                            std::string_view path) {
  std::uint64_t block = checked_bytes_of(axes, sample_bytes, path);
  std::uint64_t last = 0;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    block /= static_cast<std::uint64_t>(axes[n].size);
    const bool whole = std::find(choice.axis.begin(), choice.axis.end(), n) != choice.axis.end();
    last += block * static_cast<std::uint64_t>(whole ? axes[n].size - 1 : choice.at[n]);
  }
  return last + sample_bytes;
}

std::uint64_t checked_bytes_of(const std::vector<ArrayAxis>& axes, std::size_t sample_bytes, std::string_view path) {
  auto bytes = static_cast<std::int64_t>(sample_bytes);
  for (const ArrayAxis& axis : axes) {
    if (axis.size < 1 || __builtin_mul_overflow(bytes, axis.size, &bytes)) {
      bad_input(path, "axes of at least one sample and fewer than 2^63 bytes in all",
                "one with " + std::to_string(axis.size));
    }
  }
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace isoweave
