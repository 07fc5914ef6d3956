// JPEG streams by GDCM, and by a small writer for what GDCM does not write; read by us and by GDCM.
#include <gdcmJPEGCodec.h>

#include <cmath>
#include <functional>
#include <random>

#include "dicom_helpers.hpp"
#include "isoweave/error.hpp"
#include "volume/formats/dicom/jpeg.hpp"

namespace isoweave::testing::volume_jpeg_test {
namespace {

using namespace dicom_files;

const std::string kLosslessSyntax = "1.2.840.10008.1.2.4.57";
const std::string kBaselineSyntax = "1.2.840.10008.1.2.4.50";
const std::string kExtendedSyntax = "1.2.840.10008.1.2.4.51";

struct Image {
  int columns = 0;
  int rows = 0;
  int bits = 0;
  std::vector<std::uint16_t> samples;
};

// Smooth, with noise, and with jumps from one end of the range to the other.
Image image(int columns, int rows, int bits) {
  Image made{columns, rows, bits, {}};
  std::mt19937 random(static_cast<unsigned>(columns * 1000 + rows * 10 + bits));
  const int most = (1 << bits) - 1;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double wave = 0.5 + 0.3 * std::sin(0.2 * x) * std::cos(0.13 * y);
      int value = static_cast<int>(wave * most) + static_cast<int>(random() % 7) - 3;
      if (random() % 50 == 0) value = random() % 2 == 0 ? 0 : most;
      made.samples.push_back(static_cast<std::uint16_t>(std::clamp(value, 0, most)));
    }
  }
  return made;
}

DicomFields fields_of(const Image& image) {
  DicomFields fields;
  fields.columns = image.columns;
  fields.rows = image.rows;
  fields.bits = image.bits > 8 ? 16 : 8;
  return fields;
}

std::string stored_image(const Image& image) {
  if (image.bits > 8) return stored(image.samples);
  return stored(std::vector<std::uint8_t>(image.samples.begin(), image.samples.end()));
}

std::vector<std::uint16_t> read_image(const std::string& path, int bits) {
  if (bits > 8) return read_file<std::uint16_t>(path);
  const std::vector<std::uint8_t> bytes = read_file<std::uint8_t>(path);
  return {bytes.begin(), bytes.end()};
}

std::vector<std::uint16_t> read_by_gdcm(const std::string& path, int bits) {
  gdcm::ImageReader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read()) return {};
  std::string bytes(reader.GetImage().GetBufferLength(), '\0');
  if (!reader.GetImage().GetBuffer(bytes.data())) return {};
  std::vector<std::uint16_t> samples;
  const std::size_t width = bits > 8 ? 2 : 1;
  for (std::size_t at = 0; at < bytes.size(); at += width) {
    std::uint16_t sample = 0;
    std::memcpy(&sample, bytes.data() + at, width);
    samples.push_back(sample);
  }
  return samples;
}

int largest_difference(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b) {
  if (a.size() != b.size()) return 1 << 20;
  int most = 0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, std::abs(int{a[n]} - int{b[n]}));
  return most;
}

// Writes an image with GDCM's codec; quality: 0 for lossless.
bool write_by_gdcm(const Image& image, const std::string& path, gdcm::TransferSyntax::TSType syntax, int quality) {
  const TempFolder folder;
  DicomFields fields = fields_of(image);
  std::string file = dicom(fields, stored_image(image));
  if (image.bits != fields.bits) {
    // Fewer bits stored than allocated.
    const std::string before = us(0x101, fields.bits) + us(0x102, fields.bits - 1);
    file.replace(file.find(before), before.size(), us(0x101, image.bits) + us(0x102, image.bits - 1));
  }
  gdcm::ImageReader reader;
  reader.SetFileName(folder.put("a", file).c_str());
  if (!reader.Read()) return false;
  gdcm::JPEGCodec codec;
  codec.SetLossless(quality == 0);
  if (quality > 0) codec.SetQuality(quality);
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(gdcm::TransferSyntax(syntax));
  change.SetInput(reader.GetImage());
  change.SetUserCodec(&codec);
  if (!change.Change()) return false;
  gdcm::ImageWriter writer;
  writer.SetFile(reader.GetFile());
  writer.SetImage(change.GetOutput());
  writer.SetFileName(path.c_str());
  return writer.Write();
}

// The entropy-coded part of a stream, most significant bit first.
class Bits {
 public:
  void put(std::uint32_t value, int count) {
    for (int n = count - 1; n >= 0; --n) {
      byte_ = byte_ << 1 | (value >> n & 1);
      if (++filled_ == 8) flush_byte();
    }
  }

  // A number and the code of how long it is; codes are the places of their symbols, in five bits.
  void put_number(int value, const std::function<int(int)>& code_of_length) {
    int length = 0;
    while (std::abs(value) >> length != 0) ++length;
    put(static_cast<std::uint32_t>(code_of_length(length)), 5);
    if (length == 16) return;
    put(static_cast<std::uint32_t>(value < 0 ? value + (1 << length) - 1 : value), length);
  }

  void restart(int n) {
    while (filled_ != 0) put(1, 1);
    if (n >= 0) out_ += std::string("\xff") + static_cast<char>(0xd0 + n % 8);
  }

  const std::string& finish() {
    restart(-1);
    return out_;
  }

 private:
  void flush_byte() {
    out_ += static_cast<char>(byte_);
    if ((byte_ & 0xff) == 0xff) out_ += '\0';
    byte_ = 0;
    filled_ = 0;
  }

  std::string out_;
  std::uint32_t byte_ = 0;
  int filled_ = 0;
};

std::string two_bytes(int value) { return {static_cast<char>(value >> 8), static_cast<char>(value)}; }

std::string segment(int marker, const std::string& content) {
  return std::string("\xff") + static_cast<char>(marker) + two_bytes(static_cast<int>(content.size()) + 2) + content;
}

// Codes of five bits for all symbols.
std::string codes(int name, const std::string& symbols) {
  std::string counts(16, '\0');
  counts[4] = static_cast<char>(symbols.size());
  return segment(0xc4, static_cast<char>(name) + counts + symbols);
}

std::string frame(int marker, const Image& image) {
  return segment(marker, static_cast<char>(image.bits) + two_bytes(image.rows) + two_bytes(image.columns) +
                             std::string("\x01\x01\x11\x00", 4));
}

struct Lossless {
  int predictor = 1;
  int point_transform = 0;
  int rows_between_restarts = 0;
};

int expected_sample(const Image& image, const Lossless& how, int x, int y) {
  const auto at = [&](int dx, int dy) {
    return image.samples[static_cast<std::size_t>((y - dy) * image.columns + x - dx)] >> how.point_transform;
  };
  const bool fresh = y == 0 || (how.rows_between_restarts > 0 && y % how.rows_between_restarts == 0);
  if (fresh) return x == 0 ? 1 << (image.bits - how.point_transform - 1) : at(1, 0);
  if (x == 0) return at(0, 1);
  const int a = at(1, 0), b = at(0, 1), c = at(1, 1);
  const std::array<int, 8> all{0, a, b, c, a + b - c, a + ((b - c) >> 1), b + ((a - c) >> 1), (a + b) >> 1};
  return all[static_cast<std::size_t>(how.predictor)];
}

std::string lossless_stream(const Image& image, const Lossless& how) {
  std::string lengths;
  for (int n = 0; n <= 16; ++n) lengths += static_cast<char>(n);
  std::string stream = "\xff\xd8" + segment(0xe0, "application") + segment(0xfe, "comment") + codes(0, lengths);
  if (how.rows_between_restarts > 0) stream += segment(0xdd, two_bytes(how.rows_between_restarts * image.columns));
  stream += "\xff" + frame(0xc3, image);
  stream += segment(0xda, std::string("\x01\x01\x00", 3) + static_cast<char>(how.predictor) + '\0' +
                              static_cast<char>(how.point_transform));
  Bits bits;
  for (int y = 0; y < image.rows; ++y) {
    if (how.rows_between_restarts > 0 && y > 0 && y % how.rows_between_restarts == 0)
      bits.restart(y / how.rows_between_restarts - 1);
    for (int x = 0; x < image.columns; ++x) {
      const int sample = image.samples[static_cast<std::size_t>(y * image.columns + x)] >> how.point_transform;
      int difference = static_cast<std::int16_t>(sample - expected_sample(image, how, x, y));
      if (difference == -32768) difference = 32768;
      bits.put_number(difference, [](int length) { return length; });
    }
  }
  return stream + bits.finish() + "\xff\xd9";
}

// Blocks with a DC and some AC coefficients, at any of the 64 places.
std::string blocks_stream(int columns, int rows, int bits_of_sample, int blocks_between_restarts) {
  std::mt19937 random(7);
  Image size{columns, rows, bits_of_sample, {}};
  std::string dc_lengths, ac_codes;
  for (int n = 0; n <= 11; ++n) dc_lengths += static_cast<char>(n);
  for (int run = 0; run < 16; ++run) ac_codes += static_cast<char>(run << 4 | 2);
  ac_codes += std::string("\x00\xf0", 2);
  constexpr std::uint32_t kEnd = 16, kSixteenZeros = 17;
  std::string quantization(1, '\0');
  for (int n = 0; n < 64; ++n) quantization += static_cast<char>(n == 0 ? 4 : 10 + n);
  std::string stream = "\xff\xd8" + segment(0xdb, quantization) + codes(0, dc_lengths) + codes(0x10, ac_codes);
  if (blocks_between_restarts > 0) stream += segment(0xdd, two_bytes(blocks_between_restarts));
  stream += frame(bits_of_sample == 8 ? 0xc0 : 0xc1, size) + segment(0xda, std::string("\x01\x01\x00\x00\x3f\x00", 6));
  Bits bits;
  int dc = 0;
  const int blocks = (columns + 7) / 8 * ((rows + 7) / 8);
  for (int n = 0; n < blocks; ++n) {
    if (blocks_between_restarts > 0 && n > 0 && n % blocks_between_restarts == 0) {
      bits.restart(n / blocks_between_restarts - 1);
      dc = 0;
    }
    const int next = static_cast<int>(random() % 400) - 200;
    bits.put_number(next - dc, [](int length) { return length; });
    dc = next;
    int place = 1;
    for (; place < 64; ++place) {
      const auto run = static_cast<int>(random() % 24);
      if (place + run > 63) break;
      place += run;
      if (run >= 16) bits.put(kSixteenZeros, 5);
      bits.put(static_cast<std::uint32_t>(run % 16), 5);
      bits.put(random() % 4, 2);
    }
    if (place < 64) bits.put(kEnd, 5);
  }
  return stream + bits.finish() + "\xff\xd9";
}

std::vector<std::uint16_t> decode(const std::string& stream, const Image& image, int used = 16) {
  return decode_jpeg("a.jpg", std::as_bytes(std::span(stream)), image.columns, image.rows, used);
}

std::string refused(const std::string& stream, const Image& image) {
  try {
    decode(stream, image);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(Jpeg, ReadsLosslessFramesByGdcm) {
  for (const int bits : {8, 12, 16}) {
    for (const auto& [columns, rows] : {std::pair(64, 48), std::pair(1, 40), std::pair(53, 37)}) {
      SCOPED_TRACE(std::to_string(bits) + ", " + std::to_string(columns));
      const TempFolder folder;
      const Image made = image(columns, rows, bits);
      ASSERT_TRUE(write_by_gdcm(made, folder / "b", gdcm::TransferSyntax::JPEGLosslessProcess14_1, 0));
      EXPECT_EQ(read_image(folder / "b", bits), made.samples);
    }
  }
}

// Of 12 bits it writes blocks that no standard knows.
TEST(Jpeg, ReadsBlocksByGdcmAsGdcmDoes) {
  for (const int quality : {30, 90, 100}) {
    SCOPED_TRACE(quality);
    const TempFolder folder;
    const Image made = image(93, 70, 8);
    ASSERT_TRUE(write_by_gdcm(made, folder / "b", gdcm::TransferSyntax::JPEGBaselineProcess1, quality));
    const std::vector<std::uint16_t> ours = read_image(folder / "b", 8);
    EXPECT_LE(largest_difference(ours, read_by_gdcm(folder / "b", 8)), 1);
    EXPECT_NE(ours, made.samples);
  }
}

TEST(Jpeg, ReadsEveryPredictorPointTransformAndRestart) {
  for (const int bits : {8, 12, 16}) {
    const Image made = image(31, 22, bits);
    for (int predictor = 1; predictor <= 7; ++predictor) {
      for (const int rows_between_restarts : {0, 1, 5}) {
        SCOPED_TRACE(std::to_string(bits) + ", " + std::to_string(predictor) + ", " +
                     std::to_string(rows_between_restarts));
        const std::string stream = lossless_stream(made, {predictor, 0, rows_between_restarts});
        EXPECT_EQ(decode(stream, made), made.samples);
        const TempFolder folder;
        folder.put("a", packed_image(fields_of(made), kLosslessSyntax, stream));
        EXPECT_EQ(read_image(folder / "a", bits), made.samples);
        EXPECT_EQ(read_by_gdcm(folder / "a", bits), made.samples);
      }
    }
    Image coarse = made;
    for (std::uint16_t& sample : coarse.samples) sample = static_cast<std::uint16_t>(sample >> 3 << 3);
    EXPECT_EQ(decode(lossless_stream(made, {4, 3, 2}), made), coarse.samples);
  }
}

TEST(Jpeg, ReadsBlocksWithAndWithoutRestartsAsGdcmDoes) {
  for (const int bits : {8, 12}) {
    for (const int blocks_between_restarts : {0, 1, 7}) {
      SCOPED_TRACE(std::to_string(bits) + ", " + std::to_string(blocks_between_restarts));
      const Image made = image(61, 43, bits);
      const std::string stream = blocks_stream(made.columns, made.rows, bits, blocks_between_restarts);
      const TempFolder folder;
      folder.put("a", packed_image(fields_of(made), bits == 8 ? kBaselineSyntax : kExtendedSyntax, stream));
      const std::vector<std::uint16_t> ours = decode(stream, made);
      EXPECT_EQ(read_image(folder / "a", bits), ours);
      EXPECT_LE(largest_difference(ours, read_by_gdcm(folder / "a", bits)), 1);
      EXPECT_GT(*std::max_element(ours.begin(), ours.end()), *std::min_element(ours.begin(), ours.end()) + 50);
    }
  }
}

// As many bits as are stored: the rest is masked later, and what lies above would become small.
TEST(Jpeg, CutsLossySamplesOff) {
  const Image made = image(61, 43, 12);
  const std::string stream = blocks_stream(made.columns, made.rows, 12, 0);
  std::vector<std::uint16_t> expected = decode(stream, made);
  const auto middle = static_cast<std::uint16_t>((1 << 11) - 1);
  ASSERT_GT(*std::max_element(expected.begin(), expected.end()), middle);
  for (std::uint16_t& sample : expected) sample = std::min(sample, middle);
  EXPECT_EQ(decode(stream, made, 11), expected);
  const TempFolder folder;
  std::string file = packed_image(fields_of(made), kExtendedSyntax, stream);
  const std::string all = us(0x101, 16) + us(0x102, 15);
  folder.put("a", file.replace(file.find(all), all.size(), us(0x101, 11) + us(0x102, 10)));
  EXPECT_EQ(read_image(folder / "a", 12), expected);
}

// A block of one coefficient is one cosine.
TEST(Jpeg, BlocksAreSumsOfCosines) {
  const Image size{8, 8, 12, {}};
  constexpr int kStep = 100;
  const std::string quantization = std::string(1, '\0') + std::string(64, static_cast<char>(kStep));
  Bits bits;
  bits.put(0, 5);
  bits.put(0, 5);
  bits.put(5, 4);
  bits.put(1, 5);
  const std::string stream = "\xff\xd8" + segment(0xdb, quantization) + codes(0, std::string(1, '\0')) +
                             codes(0x10, std::string("\x24\x00", 2)) + frame(0xc1, size) +
                             segment(0xda, std::string("\x01\x01\x00\x00\x3f\x00", 6)) + bits.finish() + "\xff\xd9";
  // Two zeros, then a number of four bits at the third place in zigzag order: row 2, column 0.
  const double value = -10.0 * kStep;  // 0101 stands for -10
  const std::vector<std::uint16_t> samples = decode(stream, size);
  for (std::size_t y = 0; y < 8; ++y) {
    const double wave = std::cos(static_cast<double>(2 * y + 1) * 2 * M_PI / 16);
    const double expected = 2048 + value / 4 * std::sqrt(0.5) * wave;
    for (std::size_t x = 0; x < 8; ++x) EXPECT_NEAR(samples[8 * y + x], expected, 0.5 + 1e-9) << x << ", " << y;
  }
}

// Found by fuzzing: GDCM's decoder stops the program where bytes lie between two segments.
TEST(Jpeg, RefusesWhatItCannotRead) {
  const Image made = image(16, 9, 12);
  const std::string good = lossless_stream(made, {});
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string changed = good;
    return refused(changed.replace(at, bytes.size(), bytes), made);
  };
  const std::size_t frame_at = good.find("\xff\xc3");
  const std::size_t codes_at = good.find("\xff\xc4");
  const std::size_t scan_at = good.find("\xff\xda");
  EXPECT_EQ(refused(good, made), "");
  EXPECT_EQ(with(0, "x"), "a.jpg: expected decodable JPEG samples, found no start marker");
  EXPECT_TRUE(contains(with(codes_at, "xy"), "found no marker of a segment"));
  EXPECT_TRUE(contains(with(codes_at + 1, "\xcc"), "with Huffman codes, found one with the marker FFCC"));
  EXPECT_TRUE(contains(with(frame_at + 1, "\xc2"), "sequential or lossless JPEG frame"));
  EXPECT_TRUE(contains(with(frame_at + 1, "\xdc"), "found the marker FFDC"));
  EXPECT_TRUE(contains(with(frame_at + 4, "\x11"), "found samples of 17 bits"));
  EXPECT_TRUE(contains(refused(blocks_stream(16, 9, 16, 0), made), "found samples of 16 bits"));
  EXPECT_TRUE(contains(with(frame_at + 6, "\x0a"), "found 16 x 10 of them"));
  EXPECT_TRUE(contains(with(frame_at + 9, "\x02"), "found a frame that is not of one component"));
  EXPECT_TRUE(contains(with(codes_at + 5, "\x09"), "found a damaged Huffman table"));
  EXPECT_TRUE(contains(with(codes_at + 4, "\x01"), "found no Huffman table 0"));
  EXPECT_TRUE(contains(with(scan_at + 4, "\x02"), "found a scan that is not of the frame's component"));
  EXPECT_TRUE(contains(with(scan_at + 7, "\x08"), "found the predictor 8"));
  EXPECT_TRUE(contains(with(scan_at + 9, "\x0c"), "found a point transform of 12 bits"));
  const std::size_t data = scan_at + 10;
  EXPECT_TRUE(contains(refused(good.substr(0, data + 40), made), "found damaged data"));
  EXPECT_TRUE(contains(refused(good.substr(0, data + 4), made), "found 4 bytes for all of them"));
  EXPECT_TRUE(contains(refused(good.substr(0, frame_at + 5), made), "found a segment that ends too early"));
  // What lies behind the samples does not matter.
  EXPECT_EQ(decode(good.substr(0, good.size() - 2), made), made.samples);
}

TEST(Jpeg, SurvivesDamage) {
  const Image made = image(16, 9, 8);
  for (const std::string& stream : {lossless_stream(made, {4, 0, 3}), blocks_stream(16, 9, 8, 1)}) {
    const auto survives = [&](const std::string& damaged) {
      try {
        EXPECT_EQ(decode(damaged, made).size(), made.samples.size());
      } catch (const BadInput&) {
      }
    };
    for (std::size_t size = 0; size < stream.size(); ++size) survives(stream.substr(0, size));
    for (std::size_t at = 0; at < stream.size(); ++at) {
      for (const char flip : {'\x01', '\x80', '\xff'}) {
        std::string damaged = stream;
        damaged[at] = static_cast<char>(damaged[at] ^ flip);
        survives(damaged);
      }
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_jpeg_test
