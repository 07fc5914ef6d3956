// SLC, the volumes of VolVis that VTK reads: a header of words, a small picture, and slices of bytes, plain or each
// packed by run lengths behind its size.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/run_lengths.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kSlcMagic = "11111";
constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::size_t kSlcHeadBytes = 4096;  // no header is longer

// Words of a header up to its X.
class SlcWords {
 public:
  SlcWords(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  double number(std::string_view what) {
    const std::size_t begin = std::min(text_.find_first_not_of(kBlanks, position_), text_.size());
    const std::size_t end = std::min(text_.find_first_of(" \t\r\nX", begin), text_.size());
    const std::string_view word = text_.substr(begin, end - begin);
    const auto value = parse_double(word);
    if (!value) bad_input(path_, "a number as the " + std::string(what) + " of an SLC header", in_quotes(word));
    position_ = end;
    return *value;
  }

  std::int64_t integer(std::string_view what) {
    const double value = number(what);
    constexpr double kLargest = 1 << 30;
    if (!(value >= 0) || value > kLargest || value != static_cast<double>(static_cast<std::int64_t>(value))) {
      bad_input(path_, "a whole number as the " + std::string(what) + " of an SLC header", number_text(value));
    }
    return static_cast<std::int64_t>(value);
  }

  // The byte behind the X.
  std::uint64_t end() {
    const std::size_t at = text_.find_first_not_of(kBlanks, position_);
    if (at == std::string_view::npos || text_[at] != 'X') bad_input(path_, "X behind an SLC header", "something else");
    return at + 1;
  }

 private:
  std::string_view text_;
  const std::string& path_;
  std::size_t position_ = 0;
};

struct SlcHeader {
  std::array<std::int64_t, 3> dims{};
  std::array<double, 3> spacing{};
  bool packed = false;
  std::uint64_t data = 0;
};

SlcHeader read_slc_header(const FilePtr& file) {
  const std::string& path = file->path();
  const std::string head = file->head(kSlcHeadBytes);
  SlcWords words(head, path);
  words.number("magic");
  SlcHeader header;
  for (std::int64_t& side : header.dims) side = words.integer("size");
  const std::int64_t bits = words.integer("bits");
  if (bits != 8) bad_input(path, "8 bits per sample", std::to_string(bits));
  for (double& step : header.spacing) step = words.number("spacing");
  for (const char* what : {"unit", "origin", "modification"}) words.number(what);
  const std::int64_t packing = words.integer("compression");
  if (packing > 1) bad_input(path, "the SLC compression 0 or 1", std::to_string(packing));
  header.packed = packing == 1;
  // The picture has three colours.
  const auto width = static_cast<std::uint64_t>(words.integer("picture's width"));
  const auto height = static_cast<std::uint64_t>(words.integer("picture's height"));
  header.data = words.end() + 3 * width * height;
  return header;
}

// Slices that are packed one by one.
class SlcStream final : public ByteStream {
 public:
  SlcStream(std::unique_ptr<ByteStream> input, std::uint64_t slice, std::string path)
      : reader_(std::move(input)), slice_(slice), path_(std::move(path)) {}

  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size()) {
      if (left_ == 0 && !begin_slice()) return done;
      const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(out.size() - done, left_));
      const std::size_t got = runs_.decode(reader_, out.subspan(done, wanted));
      left_ -= got;
      done += got;
      if (got < wanted || runs_.taken() > stored_) bad_input(path_, "runs of a whole slice", "fewer bytes");
      if (left_ == 0) end_slice();
    }
    return done;
  }

 private:
  // Reads the size of the next slice and the X behind it; false at the end of the file.
  bool begin_slice() {
    std::string word;
    constexpr std::size_t kLongest = 32;
    for (std::optional<std::uint8_t> c = reader_.next(); c != 'X'; c = reader_.next()) {
      if (!c && trimmed(word).empty()) return false;
      if (!c || word.size() > kLongest) bad_input(path_, "the size of a packed slice and X", in_quotes(word));
      word += static_cast<char>(*c);
    }
    const auto size = parse_integer(trimmed(word));
    if (!size || *size < 0) bad_input(path_, "the size of a packed slice", in_quotes(word));
    stored_ = static_cast<std::uint64_t>(*size);
    runs_ = RunLengths();
    left_ = slice_;
    return true;
  }

  // Behind the runs there is a byte that ends them.
  void end_slice() {
    for (std::uint64_t n = runs_.taken(); n < stored_; ++n) {
      if (!reader_.next()) bad_input(path_, "a whole packed slice", "the end of the file");
    }
  }

  ByteReader reader_;
  RunLengths runs_;
  std::uint64_t slice_;
  std::uint64_t left_ = 0;    // bytes of the slice
  std::uint64_t stored_ = 0;  // bytes it is packed in
  std::string path_;
};

}  // namespace

bool is_slc(std::string_view head) {
  return head.starts_with(kSlcMagic) && head.size() > kSlcMagic.size() &&
         kBlanks.find(head[kSlcMagic.size()]) != kBlanks.npos;
}

OpenedVolume open_slc(const FilePtr& file) {
  const SlcHeader header = read_slc_header(file);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "slc";
  info.dims = header.dims;
  info.type = SampleType::kUint8;
  const std::uint64_t bytes = checked_volume_bytes(info);
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) axes.steps[axis][axis] = header.spacing[axis];
  set_geometry(info.geometry, axes, info.path);
  if (!header.packed) {
    volume.samples = samples_in(file, header.data, bytes);
    return volume;
  }
  check_plausible(info.path, bytes, file->size() - std::min(header.data, file->size()), kRunRatio);
  auto stored = std::make_unique<FileStream>(file, header.data, file->size());
  volume.samples = std::make_unique<SlcStream>(std::move(stored), info.slice_bytes(), info.path);
  return volume;
}

}  // namespace isoweave
