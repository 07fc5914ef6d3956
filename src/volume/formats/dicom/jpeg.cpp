#include "volume/formats/dicom/jpeg.hpp"

#include <array>
#include <optional>
#include <string_view>

#include "files/input_file.hpp"
#include "volume/formats/dicom/jpeg_scans.hpp"

namespace isoweave {
namespace {

using Bytes = std::span<const std::byte>;

// Second bytes of markers.
enum Marker : std::uint32_t {
  kBaseline = 0xc0,
  kExtended = 0xc1,
  kLossless = 0xc3,
  kHuffman = 0xc4,
  kLastFrame = 0xcf,
  kStart = 0xd8,
  kScan = 0xda,
  kQuantization = 0xdb,
  kRestartInterval = 0xdd,
  kApplication = 0xe0,
  kLastApplication = 0xef,
  kComment = 0xfe,
  kFilling = 0xff,
};

std::uint32_t byte_at(Bytes bytes, std::size_t at) { return std::to_integer<std::uint32_t>(bytes[at]); }
std::uint32_t pair_at(Bytes bytes, std::size_t at) { return byte_at(bytes, at) << 8 | byte_at(bytes, at + 1); }

std::string hexadecimal(std::uint32_t marker) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  return std::string("FF") + kDigits[marker >> 4] + kDigits[marker & 15];
}

// Goes through the segments of a stream up to its first scan, and decodes that.
class JpegReader {
 public:
  JpegReader(const std::string& path, Bytes stream, int used) : path_(path), stream_(stream), used_(used) {}

  std::vector<std::uint16_t> samples(std::int64_t columns, std::int64_t rows) {
    if (stream_.size() < 2 || pair_at(stream_, 0) != (kFilling << 8 | kStart)) damaged("no start marker");
    at_ = 2;
    for (;;) {
      const std::uint32_t marker = next_marker();
      const Bytes segment = next_segment();
      if (marker == kScan) return scan(segment);
      if (marker == kHuffman) {
        read_codes(segment);
      } else if (marker == kQuantization) {
        read_quantization(segment);
      } else if (marker == kRestartInterval) {
        read_restart(segment);
      } else if (marker >= kBaseline && marker <= kLastFrame) {
        read_frame(marker, segment, columns, rows);
      } else if (marker != kComment && (marker < kApplication || marker > kLastApplication)) {
        damaged("the marker " + hexadecimal(marker));
      }
    }
  }

 private:
  static constexpr std::size_t kTables = 4;

  [[noreturn]] void damaged(const std::string& found) const { bad_input(path_, "decodable JPEG samples", found); }

  std::uint32_t next_marker() {
    if (at_ >= stream_.size() || byte_at(stream_, at_) != kFilling) damaged("no marker of a segment");
    while (at_ < stream_.size() && byte_at(stream_, at_) == kFilling) ++at_;
    if (at_ == stream_.size()) damaged("no segment behind a marker");
    return byte_at(stream_, at_++);
  }

  Bytes next_segment() {
    constexpr std::size_t kLength = 2;
    const std::size_t left = stream_.size() - at_;
    const std::size_t length = left < kLength ? 0 : pair_at(stream_, at_);
    if (length < kLength || length > left) damaged("a segment that ends too early");
    const Bytes segment = stream_.subspan(at_ + kLength, length - kLength);
    at_ += length;
    return segment;
  }

  void read_codes(Bytes segment) {
    constexpr std::size_t kHead = 1 + HuffmanCode::kLongest;
    while (!segment.empty()) {
      if (segment.size() < kHead) damaged("a Huffman table that ends too early");
      const auto counts = segment.subspan<1, HuffmanCode::kLongest>();
      std::size_t symbols = 0;
      for (const std::byte count : counts) symbols += std::to_integer<std::size_t>(count);
      const std::uint32_t name = byte_at(segment, 0);
      if (symbols > segment.size() - kHead || (name >> 4) > 1 || (name & 15) >= kTables)
        damaged("a damaged Huffman table");
      HuffmanCode& code = codes_[name >> 4][name & 15].emplace();
      if (!code.define(counts, segment.subspan(kHead, symbols))) damaged("a damaged Huffman table");
      segment = segment.subspan(kHead + symbols);
    }
  }

  void read_quantization(Bytes segment) {
    while (!segment.empty()) {
      const std::uint32_t name = byte_at(segment, 0);
      const std::size_t width = (name >> 4) + 1;
      const std::size_t size = 1 + 64 * width;
      if (width > 2 || (name & 15) >= kTables || segment.size() < size) damaged("a damaged quantization table");
      JpegQuantization& quantization = quantization_[name & 15].emplace();
      for (std::size_t n = 0; n < quantization.size(); ++n) {
        quantization[n] =
            static_cast<std::uint16_t>(width == 1 ? byte_at(segment, 1 + n) : pair_at(segment, 1 + 2 * n));
      }
      segment = segment.subspan(size);
    }
  }

  void read_restart(Bytes segment) {
    if (segment.size() != 2) damaged("a damaged restart interval");
    restart_ = pair_at(segment, 0);
  }

  void read_frame(std::uint32_t marker, Bytes segment, std::int64_t columns, std::int64_t rows) {
    constexpr std::size_t kSize = 6 + 3;
    lossless_ = marker == kLossless;
    if (marker != kBaseline && marker != kExtended && !lossless_) {
      bad_input(path_, "a sequential or lossless JPEG frame with Huffman codes",
                "one with the marker " + hexadecimal(marker));
    }
    if (size_.bits > 0) damaged("a second frame");
    if (segment.size() != kSize || byte_at(segment, 5) != 1) damaged("a frame that is not of one component");
    size_ = {pair_at(segment, 3), pair_at(segment, 1), static_cast<int>(byte_at(segment, 0))};
    component_ = byte_at(segment, 6);
    table_ = byte_at(segment, 8);
    const bool depth = lossless_ ? size_.bits >= 2 && size_.bits <= 16 : size_.bits == 8 || size_.bits == 12;
    if (!depth) damaged("samples of " + std::to_string(size_.bits) + " bits");
    if (size_.columns != columns || size_.rows != rows || columns == 0 || rows == 0) {
      damaged(std::to_string(size_.columns) + " x " + std::to_string(size_.rows) + " of them");
    }
  }

  const HuffmanCode& code(std::uint32_t kind, std::uint32_t name) const {
    if (name >= kTables || !codes_[kind][name]) damaged("no Huffman table " + std::to_string(name));
    return *codes_[kind][name];
  }

  std::vector<std::uint16_t> scan(Bytes segment) const {
    constexpr std::size_t kSize = 6;
    if (size_.bits == 0) damaged("a scan without a frame");
    if (segment.size() != kSize || byte_at(segment, 0) != 1 || byte_at(segment, 1) != component_) {
      damaged("a scan that is not of the frame's component");
    }
    const std::uint32_t names = byte_at(segment, 2);
    std::vector<std::uint16_t> samples;
    const JpegBits bits(stream_.subspan(at_));
    const bool decoded = lossless_ ? lossless_scan(segment, code(0, names >> 4), bits, samples)
                                   : block_scan(code(0, names >> 4), code(1, names & 15), bits, samples);
    if (!decoded) damaged("damaged data");
    return samples;
  }

  bool lossless_scan(Bytes segment, const HuffmanCode& code, const JpegBits& bits,
                     std::vector<std::uint16_t>& samples) const {
    const auto predictor = static_cast<int>(byte_at(segment, 3));
    const auto point_transform = static_cast<int>(byte_at(segment, 5) & 15);
    if (predictor < 1 || predictor > 7) damaged("the predictor " + std::to_string(predictor));
    if (point_transform >= size_.bits) damaged("a point transform of " + std::to_string(point_transform) + " bits");
    expect_bits(size_.samples());
    return decode_lossless(size_, {code, predictor, point_transform, restart_}, bits, samples);
  }

  bool block_scan(const HuffmanCode& dc, const HuffmanCode& ac, const JpegBits& bits,
                  std::vector<std::uint16_t>& samples) const {
    if (table_ >= kTables || !quantization_[table_]) damaged("no quantization table " + std::to_string(table_));
    const auto blocks = [](std::int64_t length) { return static_cast<std::size_t>((length + 7) / 8); };
    expect_bits(2 * blocks(size_.columns) * blocks(size_.rows));
    return decode_blocks(size_, {dc, ac, *quantization_[table_], used_, restart_}, bits, samples);
  }

  // Fails unless the stream has so many bits. Called before anything is made as large as a frame declares: no code is
  // shorter than a bit.
  void expect_bits(std::size_t least) const {
    if (8 * (stream_.size() - at_) < least) damaged(std::to_string(stream_.size() - at_) + " bytes for all of them");
  }

  const std::string& path_;
  Bytes stream_;
  int used_;
  std::size_t at_ = 0;
  std::array<std::array<std::optional<HuffmanCode>, kTables>, 2> codes_;
  std::array<std::optional<JpegQuantization>, kTables> quantization_;
  JpegSize size_;
  bool lossless_ = false;
  std::uint32_t component_ = 0;
  std::uint32_t table_ = 0;  // of quantization
  std::uint32_t restart_ = 0;
};

}  // namespace

std::vector<std::uint16_t> decode_jpeg(const std::string& path, Bytes stream, std::int64_t columns, std::int64_t rows,
                                       int used) {
  return JpegReader(path, stream, used).samples(columns, rows);
}

}  // namespace isoweave
