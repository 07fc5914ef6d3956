#include "volume/data_files.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "files/header_text.hpp"
#include "files/part_file.hpp"
#include "files/quoted.hpp"
#include "volume/text_streams.hpp"

namespace isoweave {
namespace {

// Byte behind `lines` line ends, counted from `begin`.
std::uint64_t behind_lines(const FilePtr& file, std::uint64_t begin, std::int64_t lines) {
  std::array<std::byte, 4096> buffer;
  std::uint64_t position = begin;
  while (lines > 0) {
    const std::size_t got = file->read_at(position, buffer);
    if (got == 0) bad_input(file->path(), std::to_string(lines) + " more lines to skip", "the end of the file");
    std::size_t used = 0;
    while (used < got && lines > 0) lines -= buffer[used++] == std::byte{'\n'} ? 1 : 0;
    position += used;
  }
  return position;
}

// Bytes that follow the samples, for a negative skip.
std::uint64_t bytes_behind(std::int64_t byte_skip) { return static_cast<std::uint64_t>(-(byte_skip + 1)); }

[[noreturn]] void too_short(const FilePtr& file, std::uint64_t begin, std::uint64_t bytes) {
  bad_input(file->path(), std::to_string(bytes) + " bytes of samples from byte " + std::to_string(begin) + " on",
            "a file of " + file->size_text());
}

std::unique_ptr<ByteStream> open_plain(const FilePtr& file, std::uint64_t begin, std::int64_t byte_skip,
                                       std::uint64_t bytes) {
  // Takes differences, not sums: the numbers come from a header and may be of any size.
  const std::uint64_t size = byte_skip >= 0 ? file->size() : file->exact_size();
  const std::uint64_t available = size - std::min(begin, size);
  const std::uint64_t aside = byte_skip >= 0 ? static_cast<std::uint64_t>(byte_skip) : bytes_behind(byte_skip);
  if (aside > available || bytes > available - aside) too_short(file, begin, bytes);
  const std::uint64_t first = byte_skip >= 0 ? begin + aside : size - aside - bytes;
  return std::make_unique<FileStream>(file, first, first + bytes);
}

std::unique_ptr<ByteStream> inflated(const FilePtr& file, std::uint64_t begin) {
  return std::make_unique<InflateStream>(std::make_unique<FileStream>(file, begin, file->size()), file->path());
}

std::unique_ptr<ByteStream> open_compressed(const FilePtr& file, std::uint64_t begin, std::int64_t byte_skip,
                                            std::uint64_t bytes) {
  check_plausible(file->path(), bytes, file->size() - std::min(begin, file->size()), kDeflateRatio);
  std::uint64_t skip = static_cast<std::uint64_t>(std::max<std::int64_t>(byte_skip, 0));
  if (byte_skip < 0) {
    // The end of a packed file is known only when everything has been inflated.
    const std::uint64_t total = inflated(file, begin)->skip(std::numeric_limits<std::uint64_t>::max());
    const std::uint64_t aside = bytes_behind(byte_skip);
    if (aside > total || bytes > total - aside) {
      bad_input(file->path(), std::to_string(bytes) + " bytes of samples once inflated", std::to_string(total));
    }
    skip = total - aside - bytes;
  }
  auto samples = inflated(file, begin);
  if (samples->skip(skip) < skip) {
    bad_input(file->path(), "samples behind " + std::to_string(skip) + " inflated bytes", "fewer bytes");
  }
  return samples;
}

std::unique_ptr<ByteStream> open_text(const FilePtr& file, std::uint64_t begin, const DataLayout& layout,
                                      std::uint64_t bytes) {
  if (layout.byte_skip < 0) bad_input(file->path(), "a byte skip of at least 0", std::to_string(layout.byte_skip));
  const std::uint64_t available = file->size() - std::min(begin, file->size());
  const auto skip = std::min<std::uint64_t>(static_cast<std::uint64_t>(layout.byte_skip), available);
  auto text = std::make_unique<FileStream>(file, begin + skip, file->size());
  if (layout.encoding == DataLayout::Encoding::kHex) {
    check_plausible(file->path(), bytes, (available - skip) / 2, 1);
    return std::make_unique<HexStream>(std::move(text), file->path());
  }
  // A digit and a blank for each sample, but for the last.
  const std::uint64_t samples = bytes / sample_bytes(layout.type);
  check_plausible(file->path(), samples, (available - skip + 1) / 2, 1);
  return std::make_unique<NumberStream>(std::move(text), NumberText{layout.type, samples, true}, file->path());
}

// The only conversion that a file name pattern may hold, cut in three.
struct NamePattern {
  std::string before;
  std::string after;
  std::size_t width = 0;
  char fill = ' ';
};

NamePattern parse_pattern(const std::string& header_path, const std::string& text) {
  const auto refuse = [&] { bad_input(header_path, "a file name pattern with one %d, such as %03d", in_quotes(text)); };
  NamePattern pattern;
  const std::size_t percent = text.find('%');
  if (percent == std::string::npos || text.find('%', percent + 1) != std::string::npos) refuse();
  std::size_t at = percent + 1;
  if (at < text.size() && text[at] == '0') pattern.fill = '0';
  constexpr std::size_t kWidest = 64;
  for (; at < text.size() && text[at] >= '0' && text[at] <= '9' && pattern.width <= kWidest; ++at) {
    pattern.width = pattern.width * 10 + static_cast<std::size_t>(text[at] - '0');
  }
  if (at >= text.size() || pattern.width > kWidest) refuse();
  if (text[at] != 'd' && text[at] != 'i' && text[at] != 'u') refuse();
  pattern.before = text.substr(0, percent);
  pattern.after = text.substr(at + 1);
  return pattern;
}

std::string name_of(const NamePattern& pattern, std::int64_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < pattern.width) digits.insert(0, pattern.width - digits.size(), pattern.fill);
  return pattern.before + digits + pattern.after;
}

}  // namespace

DataFiles listed_files(const std::string& header_path, const std::vector<std::string>& names) {
  return {static_cast<std::int64_t>(names.size()),
          [header_path, names](std::int64_t n) { return beside(header_path, names[static_cast<std::size_t>(n)]); }};
}

DataFiles numbered_files(const std::string& header_path, const std::string& pattern,
                         const std::vector<std::int64_t>& numbers) {
  const NamePattern parts = parse_pattern(header_path, pattern);
  const std::int64_t first = numbers.at(0);
  const std::int64_t last = numbers.at(1);
  const std::int64_t step = numbers.at(2);
  constexpr std::int64_t kLargest = std::int64_t{1} << 40;
  const bool sane =
      first >= 0 && last >= 0 && first < kLargest && last < kLargest && step > -kLargest && step < kLargest;
  if (!sane || step == 0 || (last - first) / step < 0 || (last != first && (last > first) != (step > 0))) {
    bad_input(header_path, "file numbers FIRST LAST STEP that lead from the first to the last",
              std::to_string(first) + " " + std::to_string(last) + " " + std::to_string(step));
  }
  return {(last - first) / step + 1,
          [=](std::int64_t n) { return beside(header_path, name_of(parts, first + n * step)); }};
}

std::unique_ptr<ByteStream> open_samples(const FilePtr& file, std::uint64_t begin, const DataLayout& layout,
                                         std::uint64_t bytes) {
  if (layout.line_skip < 0) bad_input(file->path(), "a line skip of at least 0", std::to_string(layout.line_skip));
  const std::uint64_t from = behind_lines(file, begin, layout.line_skip);
  switch (layout.encoding) {
    case DataLayout::Encoding::kRaw:
      return open_plain(file, from, layout.byte_skip, bytes);
    case DataLayout::Encoding::kDeflate:
      return open_compressed(file, from, layout.byte_skip, bytes);
    case DataLayout::Encoding::kNumbers:
    case DataLayout::Encoding::kHex:
      break;
  }
  return open_text(file, from, layout, bytes);
}

std::unique_ptr<ByteStream> open_only_file(VolumeInfo& info, const FilePtr& file, std::uint64_t begin,
                                           const DataLayout& layout, std::uint64_t bytes) {
  auto samples = open_samples(file, begin, layout, bytes);
  if (file->path() != info.path) info.data_files = {file->path()};
  if (layout.encoding != DataLayout::Encoding::kRaw || layout.byte_skip < 0 || !file->jumps()) return samples;
  const std::uint64_t from = behind_lines(file, begin, layout.line_skip);
  const std::uint64_t behind = file->size() - from - static_cast<std::uint64_t>(layout.byte_skip) - bytes;
  if (behind > 0) {
    info.notes.push_back(std::to_string(behind) + " bytes behind the samples that the header describes are not read");
  }
  return samples;
}

std::unique_ptr<ByteStream> open_samples(VolumeInfo& info, const DataFiles& files, const DataLayout& layout,
                                         std::uint64_t bytes) {
  const auto count = static_cast<std::uint64_t>(files.count);
  if (count == 0 || bytes % count != 0) {
    bad_input(info.path, "files that share " + std::to_string(bytes) + " bytes equally",
              std::to_string(files.count) + " files");
  }
  const std::uint64_t each = bytes / count;
  const auto open = [=, path = info.path](std::int64_t n) {
    return open_samples(open_part(path, "its samples in", files.name(n)), 0, layout, each);
  };
  for (std::int64_t n = 0; n < files.count; ++n) {
    open(n);
    info.data_files.push_back(files.name(n));
  }
  return std::make_unique<FileSequence>(files.count, each, open, files.name);
}

}  // namespace isoweave
