#include <algorithm>
#include <map>
#include <tuple>
#include <type_traits>

#include "tiff_helpers.hpp"

namespace isoweave::testing::volume_tiff_test {
namespace {

const std::vector<std::uint16_t> kSamples = ramp<std::uint16_t>(5 * 4 * 6);

TiffPage described(const std::string& text) {
  TiffPage page;
  page.description = text;
  return page;
}

VolumeInfo info_of(const TempFolder& folder, const TiffPage& page) {
  return open_volume(write_stack(folder / "a.tif", page, stored(kSamples)))->info();
}

std::string refusal_of(const TempFolder& folder, const TiffPage& page, const std::string& samples) {
  return refusal(write_stack(folder / "a.tif", page, samples));
}

template <class Sample>
void expect_type(const TempFolder& folder, SampleType type, std::uint16_t format) {
  // Tiles of 16 hang over both edges.
  constexpr std::uint32_t kWidth = 37;
  constexpr std::uint32_t kHeight = 21;
  const auto samples = ramp<Sample>(std::size_t{kWidth} * kHeight * 3);
  for (const std::string mode : {"wl", "wb", "w8l", "w8b"}) {
    for (const std::uint32_t tile : {0U, 16U}) {
      for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS,
                                    COMPRESSION_ZSTD, COMPRESSION_LZMA}) {
        if (TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression)) == 0) continue;
        TiffPage page{kWidth, kHeight};
        page.bits = 8 * sizeof(Sample);
        page.format = format;
        page.tile = tile;
        page.compression = static_cast<std::uint16_t>(compression);
        // libtiff 4.5 writes the floating-point predictor wrongly in the byte order that is not the machine's.
        const bool reals = std::is_floating_point_v<Sample> && !mode.ends_with('b');
        if (compression == COMPRESSION_ADOBE_DEFLATE) page.predictor = reals ? 3 : 2;
        const auto source = open_volume(write_stack(folder / "a.tif", page, stored(samples), mode));
        EXPECT_EQ(source->info().type, type);
        EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{kWidth, kHeight, 3}));
        EXPECT_EQ(samples_of<Sample>(*source), samples) << mode << " tile " << tile << " compression " << compression;
      }
    }
  }
}

TEST(Tiff, ReadsEveryTypeOrderLayoutAndCompression) {
  const TempFolder folder;
  expect_type<std::uint8_t>(folder, SampleType::kUint8, SAMPLEFORMAT_UINT);
  expect_type<std::int8_t>(folder, SampleType::kInt8, SAMPLEFORMAT_INT);
  expect_type<std::uint16_t>(folder, SampleType::kUint16, SAMPLEFORMAT_UINT);
  expect_type<std::int16_t>(folder, SampleType::kInt16, SAMPLEFORMAT_INT);
  expect_type<std::uint32_t>(folder, SampleType::kUint32, SAMPLEFORMAT_UINT);
  expect_type<std::int32_t>(folder, SampleType::kInt32, SAMPLEFORMAT_INT);
  expect_type<float>(folder, SampleType::kFloat32, SAMPLEFORMAT_IEEEFP);
  expect_type<double>(folder, SampleType::kFloat64, SAMPLEFORMAT_IEEEFP);
}

// Samples whose bits, as halves, are small: multiples of 2^-24. libtiff 4.5 writes the floating-point predictor wrongly
// in the byte order that is not the machine's.
TEST(Tiff, HalvesAreReadAsFloats) {
  const TempFolder folder;
  const std::vector<std::uint16_t> bits = ramp<std::uint16_t>(5 * 4 * 3);
  std::vector<float> expected;
  for (const std::uint16_t half : bits) expected.push_back(static_cast<float>(half) * 0x1p-24F);
  TiffPage page;
  page.format = SAMPLEFORMAT_IEEEFP;
  for (const std::string mode : {"w", "wb", "w8"}) {
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW}) {
      for (const int predictor : {1, 3}) {
        page.compression = static_cast<std::uint16_t>(compression);
        page.predictor = static_cast<std::uint16_t>(compression == COMPRESSION_NONE || mode == "wb" ? 1 : predictor);
        const std::string path = write_stack(folder / "a.tif", page, stored(bits), mode);
        EXPECT_EQ(read_file<float>(path), expected) << mode << compression << predictor;
      }
    }
  }
  // One page in each file.
  for (int k = 0; k < 3; ++k) {
    write_stack(folder / ("z" + std::to_string(k) + ".tif"), page,
                stored(bits).substr(static_cast<std::size_t>(k) * 40, 40));
  }
  EXPECT_EQ(read_file<float>(folder / "z*.tif"), expected);
}

TEST(Tiff, IsToldByItsContent) {
  const TempFolder folder;
  const auto source = open_volume(write_stack(folder / "no-ending", {}, stored(kSamples)));
  EXPECT_EQ(source->info().format, "tiff");
  EXPECT_EQ(source->info().geometry.space, Space::kUnknown);
  EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{1, 1, 1}));
  EXPECT_TRUE(contains(source->info().notes.at(0), "axis 0 is not given"));
  EXPECT_TRUE(contains(refusal(folder.put("a.tif", "hello")), "the magic of TIFF or BigTIFF"));
}

TEST(Tiff, SkipsSlicesAndPartsOfBands) {
  const TempFolder folder;
  for (const std::uint32_t tile : {0U, 16U}) {
    TiffPage page;
    page.tile = tile;
    page.compression = COMPRESSION_LZW;
    const auto source = open_volume(write_stack(folder / "a.tif", page, stored(kSamples)));
    std::vector<std::uint16_t> slices(40);
    source->read(1, 2, std::as_writable_bytes(std::span(slices)));
    EXPECT_TRUE(std::equal(slices.begin(), slices.end(), kSamples.begin() + 20));
    source->read(5, 1, std::as_writable_bytes(std::span(slices)));
    EXPECT_TRUE(std::equal(slices.begin(), slices.begin() + 20, kSamples.begin() + 100));
  }
}

TEST(Tiff, TakesSpacingUnitAndOriginFromImageJ) {
  const TempFolder folder;
  TiffPage page = described("ImageJ=1.53q\nimages=6\nslices=6\nunit=\\u00B5m\nspacing=-3.5\nxorigin=2\nzorigin=1\n");
  page.resolution = 4;
  const VolumeInfo info = info_of(folder, page);
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.25, 0.25, 3.5}));
  EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{-0.5, 0, -3.5}));
  EXPECT_EQ(info.geometry.unit, "um");
  EXPECT_TRUE(info.notes.empty());
}

TEST(Tiff, TurnsCentimetresAndInchesIntoMillimetres) {
  const TempFolder folder;
  const auto spacing = [&](const std::string& unit, std::uint16_t tag, float resolution) {
    TiffPage page = described("ImageJ=1.53q\nimages=6\n" + unit + "spacing=2\n");
    page.resolution = resolution;
    page.resolution_unit = tag;
    const VolumeInfo info = info_of(folder, page);
    EXPECT_EQ(info.geometry.unit, unit.empty() && resolution == 72 ? "" : "mm");
    return std::pair(info.geometry.spacing[0], info.geometry.spacing[2]);
  };
  EXPECT_EQ(spacing("unit=cm\n", RESUNIT_NONE, 4), std::pair(2.5, 20.0));
  EXPECT_EQ(spacing("unit=inch\n", RESUNIT_NONE, 4), std::pair(6.35, 50.8));
  EXPECT_EQ(spacing("", RESUNIT_CENTIMETER, 4), std::pair(2.5, 20.0));
  EXPECT_EQ(spacing("", RESUNIT_INCH, 4), std::pair(6.35, 50.8));
  EXPECT_EQ(spacing("", RESUNIT_INCH, 72), std::pair(1.0, 2.0));
  // Without resolution there is no unit of it.
  EXPECT_EQ(info_of(folder, described("ImageJ=1.53q\nimages=6\nspacing=2\n")).geometry.spacing[2], 2);
  const VolumeInfo odd = info_of(folder, described("ImageJ=1.53q\nunit=furlong\nspacing=2\n"));
  EXPECT_TRUE(contains(odd.notes.at(0), "'furlong'"));
  EXPECT_EQ(odd.geometry.unit, "");
}

TEST(Tiff, TakesAStraightCalibrationFromImageJ) {
  const TempFolder folder;
  const VolumeInfo info = info_of(folder, described("ImageJ=1.53q\nimages=6\ncf=0\nc0=-32768.0\nc1=0.5\n"));
  EXPECT_EQ(info.slope, 0.5);
  EXPECT_EQ(info.intercept, -32768);
}

TEST(Tiff, ReadsTheFirstChannelAndFrameOfHyperstacks) {
  const TempFolder folder;
  const std::string text = "ImageJ=1.53q\nimages=6\nchannels=2\nslices=3\nhyperstack=true\n";
  const auto source = open_volume(write_stack(folder / "a.tif", described(text), stored(kSamples)));
  EXPECT_EQ(source->info().dims[2], 3);
  EXPECT_EQ(source->info().notes.at(0), "the first of 2 along channel is read; --channel chooses");
  std::vector<std::uint16_t> expected;
  for (const std::size_t page : {0U, 2U, 4U}) {
    expected.insert(expected.end(), kSamples.begin() + static_cast<std::ptrdiff_t>(20 * page),
                    kSamples.begin() + static_cast<std::ptrdiff_t>(20 * page + 20));
  }
  EXPECT_EQ(samples_of<std::uint16_t>(*source), expected);
  const auto frames = open_volume(
      write_stack(folder / "a.tif", described("ImageJ=1.53q\nimages=6\nframes=2\nslices=3\n"), stored(kSamples)));
  EXPECT_EQ(frames->info().notes.at(0), "the first of 2 along time is read; --time chooses");
  EXPECT_EQ(samples_of<std::uint16_t>(*frames), std::vector<std::uint16_t>(kSamples.begin(), kSamples.begin() + 60));
  EXPECT_TRUE(contains(refusal_of(folder, described("ImageJ=1\nimages=6\nchannels=4\nslices=3\n"), stored(kSamples)),
                       "expected 12 images"));
  EXPECT_TRUE(contains(refusal_of(folder, described("ImageJ=1\nimages=7\n"), stored(kSamples)),
                       "expected 7 pages by its description, found 6"));
  EXPECT_TRUE(contains(refusal_of(folder, described("ImageJ=1\nimages=-1\n"), stored(kSamples)), "at least 1"));
}

std::string ome(const std::string& order, const std::string& more = "") {
  return "<?xml version=\"1.0\"?><OME><Image><Pixels ID=\"P\" DimensionOrder=\"" + order +
         "\" SizeC=\"2\" SizeT=\"1\" SizeZ=\"3\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\" PhysicalSizeZ=\"2\" " +
         more + "Type=\"uint16\"/></Image></OME>";
}

TEST(Tiff, ReadsTheFirstChannelOfOmeStacks) {
  const TempFolder folder;
  const auto source = open_volume(write_stack(folder / "a.tif", described(ome("XYCZT")), stored(kSamples)));
  EXPECT_EQ(source->info().geometry.spacing, (std::array<double, 3>{0.5, 0.5, 2}));
  EXPECT_EQ(source->info().geometry.unit, "um");
  EXPECT_EQ(samples_of<std::uint16_t>(*source)[20], kSamples[40]);
  const std::string nm = "PhysicalSizeXUnit=\"nm\" PhysicalSizeYUnit=\"nm\" PhysicalSizeZUnit=\"nm\" ";
  const auto other = open_volume(write_stack(folder / "a.tif", described(ome("XYZCT", nm)), stored(kSamples)));
  EXPECT_EQ(other->info().geometry.unit, "nm");
  EXPECT_EQ(samples_of<std::uint16_t>(*other)[20], kSamples[20]);
  const std::string lines = "PhysicalSizeXUnit=\"n\nm\" PhysicalSizeYUnit=\"n\nm\" PhysicalSizeZUnit=\"n\nm\" ";
  const auto odd = open_volume(write_stack(folder / "a.tif", described(ome("XYZCT", lines)), stored(kSamples)));
  EXPECT_EQ(odd->info().notes.at(1), "the unit 'n?m' is no length that is known and is left out");
  EXPECT_TRUE(contains(refusal_of(folder, described(ome("ZYX")), stored(kSamples)), "DimensionOrder"));
  EXPECT_TRUE(contains(refusal_of(folder, described("<OME></OME>"), stored(kSamples)), "expected Pixels"));
}

TEST(Tiff, AxesInOtherUnitsAreGivenInThatOfX) {
  const TempFolder folder;
  const std::string units = "PhysicalSizeXUnit=\"nm\" PhysicalSizeYUnit=\"nm\" PhysicalSizeZUnit=\"\xc2\xb5m\" ";
  const VolumeInfo info = info_of(folder, described(ome("XYZCT", units)));
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.5, 0.5, 2000}));
  EXPECT_EQ(info.geometry.unit, "nm");
  EXPECT_TRUE(contains(info.notes.back(), "axis 2 is in"));
  const std::string numbered = "PhysicalSizeXUnit=\"nm\" PhysicalSizeYUnit=\"nm\" PhysicalSizeZUnit=\"&#xB5;m\" ";
  EXPECT_EQ(info_of(folder, described(ome("XYZCT", numbered))).geometry.spacing[2], 2000);
  // The micrometre is OME's unit where none is given.
  EXPECT_EQ(info_of(folder, described(ome("XYZCT", "PhysicalSizeZUnit=\"mm\" "))).geometry.spacing[2], 2000);
  TiffPage page = described("ImageJ=1.53q\nimages=6\nunit=nm\nzunit=\\u00B5m\nspacing=0.05\nzorigin=2\n");
  page.resolution = 0.04F;
  const VolumeInfo imagej = info_of(folder, page);
  EXPECT_EQ(imagej.geometry.spacing[2], 50);
  EXPECT_EQ(imagej.geometry.origin[2], -100);
  EXPECT_EQ(imagej.geometry.unit, "nm");
  page.description = "ImageJ=1.53q\nimages=6\nunit=mm\nyunit=cm\nspacing=3\n";
  page.resolution = 4;
  EXPECT_EQ(info_of(folder, page).geometry.spacing, (std::array<double, 3>{0.25, 2.5, 3}));
}

TEST(Tiff, UnitsThatCannotBeMadeOneNeedASpacing) {
  const TempFolder folder;
  TiffPage page = described("ImageJ=1.53q\nimages=6\nunit=um\nzunit=pixel\nspacing=2\n");
  page.resolution = 4;
  EXPECT_TRUE(contains(refusal_of(folder, page, stored(kSamples)),
                       "expected units of length that can be made one, or --spacing, found 'um', 'um', 'pixel'"));
  TiffPage absent = described("ImageJ=1.53q\nimages=6\nzunit=um\nspacing=2\n");
  absent.resolution = 4;
  EXPECT_TRUE(contains(refusal_of(folder, absent, stored(kSamples)), "found 'pixel', 'pixel', 'um'"));
  write_stack(folder / "a.tif", page, stored(kSamples));
  OpenOptions options;
  options.spacing = {0.25, 0.25, 3};
  const VolumeInfo info = open_volume(folder / "a.tif", options)->info();
  EXPECT_EQ(info.geometry.spacing, *options.spacing);
  EXPECT_EQ(info.geometry.unit, "um");
}

// Page c + 2 * (z + 3 * t) and so on, in every order: its first sample tells which page was read.
TEST(Tiff, AChannelAndATimeAreChosenInEveryOrder) {
  const TempFolder folder;
  const auto samples = ramp<std::uint16_t>(5 * 4 * 12);
  const std::map<char, std::size_t> sizes{{'Z', 3}, {'C', 2}, {'T', 2}};
  std::string order = "CTZ";
  do {
    const std::string text =
        "<OME><Pixels DimensionOrder=\"XY" + order + "\" SizeC=\"2\" SizeT=\"2\" SizeZ=\"3\" Type=\"uint16\"/></OME>";
    write_stack(folder / "a.tif", described(text), stored(samples));
    for (std::int64_t channel = 0; channel < 2; ++channel) {
      for (std::int64_t time = 0; time < 2; ++time) {
        OpenOptions options;
        options.channel = channel;
        options.time = time;
        const auto source = open_volume(folder / "a.tif", options);
        EXPECT_EQ(source->info().part, order.find('C') < order.find('T')
                                           ? "time " + std::to_string(time) + ", channel " + std::to_string(channel)
                                           : "channel " + std::to_string(channel) + ", time " + std::to_string(time));
        const auto read = samples_of<std::uint16_t>(*source);
        for (std::size_t z = 0; z < 3; ++z) {
          const std::map<char, std::size_t> at{
              {'Z', z}, {'C', static_cast<std::size_t>(channel)}, {'T', static_cast<std::size_t>(time)}};
          std::size_t page = 0, step = 1;
          for (const char axis : order) {
            page += at.at(axis) * step;
            step *= sizes.at(axis);
          }
          EXPECT_EQ(read.at(20 * z), samples.at(20 * page)) << order << channel << time << z;
        }
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Tiff, AChoiceOutsideTheStackIsRefused) {
  const TempFolder folder;
  const std::string text = "ImageJ=1.53q\nimages=6\nchannels=2\nslices=3\n";
  const std::string path = write_stack(folder / "a.tif", described(text), stored(kSamples));
  OpenOptions options;
  options.channel = 1;
  EXPECT_EQ(samples_of<std::uint16_t>(*open_volume(path, options))[20], kSamples[60]);
  options.channel = 2;
  EXPECT_TRUE(contains(refusal(path, options), "expected --channel below 2, found 2"));
  options = {};
  options.time = 0;
  EXPECT_EQ(samples_of<std::uint16_t>(*open_volume(path, options))[20], kSamples[40]);
  EXPECT_TRUE(contains(refusal(write_stack(folder / "b.tif", {}, stored(kSamples)), options),
                       "expected an axis for --time, found axes of 6 ('z') x 4 ('y') x 5 ('x')"));
  HandMade page;
  page.big = false;
  page.description = "ImageJ=1.53q\nimages=6\nchannels=3\nslices=2\n";
  options = {};
  options.channel = 2;
  const auto contiguous = open_volume(folder.put("c.tif", hand_made(page, stored(kSamples))), options);
  EXPECT_EQ(samples_of<std::uint16_t>(*contiguous)[20], kSamples[100]);
}

TEST(Tiff, TheShapeThatTifffileWritesSaysWhatPagesAre) {
  const TempFolder folder;
  const auto read = [&](const std::string& text, const OpenOptions& options = {}) {
    return open_volume(write_stack(folder / "a.tif", described(text), stored(kSamples)), options);
  };
  for (const std::string text :
       {R"({"shape": [2, 3, 4, 5]})", R"({"axes": "CZYX", "shape": [2, 3, 4, 5]})", R"({"shape": [1, 2, 3, 4, 5]})"}) {
    const auto first = read(text);
    EXPECT_EQ(first->info().dims, (std::array<std::int64_t, 3>{5, 4, 3})) << text;
    EXPECT_TRUE(contains(first->info().notes.at(0), "the first of 2 along channel")) << text;
    OpenOptions options;
    options.channel = 1;
    EXPECT_EQ(samples_of<std::uint16_t>(*read(text, options)).at(0), kSamples.at(60)) << text;
  }
  OpenOptions options;
  options.time = 1;
  EXPECT_EQ(samples_of<std::uint16_t>(*read(R"({"shape": [3, 2, 4, 5], "axes": "ZTYX"})", options)).at(20),
            kSamples.at(60));
  for (const std::string text : {R"({"shape": [6, 4, 5]})", R"({"shape": [6, 4, 5], "axes": "QYX"})",
                                 R"({"shape": [4, 5]})", R"({"shape": [6, 4, )", R"({"shape": [x]})", "{}"}) {
    EXPECT_EQ(read(text)->info().dims[2], 6) << text;
  }
  const auto kept = read(R"({"shape": [2, 4, 4, 5]})");
  EXPECT_EQ(kept->info().dims[2], 6);
  EXPECT_TRUE(contains(kept->info().notes.at(0), "the shape in its description is of 8 pages; all 6"));
  EXPECT_TRUE(contains(refusal_of(folder, described(R"({"shape": [2, 3, 4, 5], "axes": "RZYX"})"), stored(kSamples)),
                       "expected axes x, y, z, channel and time, found 2 ('R')"));
}

TEST(Tiff, SlicesThatWereWrittenAsChannelsOrFrames) {
  const TempFolder folder;
  for (const auto& [key, word, from] :
       {std::tuple{"channels", "channel", SliceAxis::kChannels}, std::tuple{"frames", "time", SliceAxis::kTimes}}) {
    const std::string text = "ImageJ=1.53q\nimages=6\n" + std::string(key) + "=6\nspacing=2\n";
    const std::string path = write_stack(folder / "a.tif", described(text), stored(kSamples));
    const auto flat = open_volume(path);
    EXPECT_EQ(flat->info().dims[2], 1);
    EXPECT_EQ(flat->info().notes.at(0), "the first of 6 along " + std::string(word) + " is read; --" + word +
                                            " chooses, --slices-from " + word + " takes them for slices");
    OpenOptions options;
    options.slices_from = from;
    const auto deep = open_volume(path, options);
    EXPECT_EQ(samples_of<std::uint16_t>(*deep), kSamples);
    EXPECT_EQ(deep->info().geometry.spacing[2], 2);
  }
  OpenOptions options;
  options.slices_from = SliceAxis::kChannels;
  const std::string both = "ImageJ=1.53q\nimages=6\nchannels=2\nslices=3\n";
  EXPECT_TRUE(contains(refusal(write_stack(folder / "a.tif", described(both), stored(kSamples)), options),
                       "expected one slice for --slices-from channel, found 3"));
  EXPECT_TRUE(contains(refusal(write_stack(folder / "a.tif", {}, stored(kSamples)), options),
                       "expected an axis for --slices-from channel"));
  const std::string frames = "ImageJ=1.53q\nimages=6\nframes=6\n";
  EXPECT_TRUE(contains(refusal(write_stack(folder / "a.tif", described(frames), stored(kSamples)), options),
                       "expected several samples along channel for --slices-from channel, found one"));
}

TEST(Tiff, ReadsContiguousImageJStacks) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    HandMade page;
    page.big = big;
    page.description = "ImageJ=1.53q\nimages=6\nspacing=2\n";
    const auto source = open_volume(folder.put("a.tif", hand_made(page, stored(kSamples, big))));
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{5, 4, 6}));
    EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
    page.description = "ImageJ=1.53q\nimages=6\nchannels=3\nslices=2\n";
    const auto first = open_volume(folder.put("a.tif", hand_made(page, stored(kSamples, big))));
    EXPECT_EQ(samples_of<std::uint16_t>(*first)[20], kSamples[60]);
  }
  HandMade page;
  page.description = "ImageJ=1.53q\nimages=7\n";
  EXPECT_TRUE(contains(refusal(folder.put("a.tif", hand_made(page, stored(kSamples)))), "expected 7 images of 40"));
  page.compression = COMPRESSION_LZW;
  EXPECT_TRUE(contains(refusal(folder.put("a.tif", hand_made(page, stored(kSamples)))), "expected 7 pages"));
}

TEST(Tiff, ReadsImageJStacksBeyondFourGigabytes) {
  const TempFolder folder;
  HandMade page;
  page.width = 65536;
  page.height = 1;
  page.bits = 8;
  page.strip_bytes = 65536;
  page.description = "ImageJ=1.53q\nimages=98304\n";
  const std::string head = hand_made(page, "");
  const std::string path = folder.put("a.tif", head);
  std::filesystem::resize_file(path, head.size() + (std::uint64_t{3} << 31) - 1);
  std::ofstream(path, std::ios::binary | std::ios::app) << "y";
  const auto source = open_volume(path);
  EXPECT_EQ(source->info().dims[2], 98304);
  std::vector<std::byte> row(65536);
  source->read(98303, 1, row);
  EXPECT_EQ(row.front(), std::byte{0});
  EXPECT_EQ(row.back(), std::byte{'y'});
}

TEST(Tiff, RefusesWhatIsNotGrey) {
  const TempFolder folder;
  TiffPage page;
  page.samples = 3;
  page.photometric = PHOTOMETRIC_RGB;
  EXPECT_TRUE(contains(refusal_of(folder, page, std::string(5 * 4 * 6, 'x')), "expected grey samples, found RGB"));
  page.photometric = PHOTOMETRIC_MINISBLACK;
  EXPECT_TRUE(contains(refusal_of(folder, page, std::string(5 * 4 * 6, 'x')), "one sample per pixel, found 3"));
  page = {};
  page.bits = 8;
  page.photometric = PHOTOMETRIC_PALETTE;
  EXPECT_TRUE(contains(refusal_of(folder, page, std::string(5 * 4, 'x')), "found a palette"));
  page = {};
  page.bits = 8;
  page.format = SAMPLEFORMAT_IEEEFP;
  EXPECT_TRUE(contains(refusal_of(folder, page, std::string(5 * 4, 'x')), "found 8 bits of sample format 3"));
  HandMade odd;
  odd.bits = 12;
  EXPECT_TRUE(contains(refusal(folder.put("a.tif", hand_made(odd, std::string(40, 'x')))), "found 12 bits"));
}

TEST(Tiff, NotesWhatItDoesNotApply) {
  const TempFolder folder;
  TiffPage page;
  page.photometric = PHOTOMETRIC_MINISWHITE;
  const auto source = open_volume(write_stack(folder / "a.tif", page, stored(kSamples)));
  EXPECT_TRUE(contains(source->info().notes.at(0), "0 stands for white"));
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
}

TEST(Tiff, LeavesSmallerCopiesOut) {
  const TempFolder folder;
  TIFF* tiff = TIFFOpen((folder / "a.tif").c_str(), "w");
  TiffPage copy{2, 2};
  copy.subfile = FILETYPE_REDUCEDIMAGE;
  write_page(tiff, {}, stored(kSamples).substr(0, 40));
  write_page(tiff, copy, std::string(8, 'x'));
  write_page(tiff, {}, stored(kSamples).substr(40, 40));
  TIFFClose(tiff);
  const auto source = open_volume(folder / "a.tif");
  EXPECT_EQ(source->info().dims[2], 2);
  EXPECT_TRUE(contains(source->info().notes.at(0), "1 pages are masks or smaller copies"));
  EXPECT_EQ(samples_of<std::uint16_t>(*source), std::vector<std::uint16_t>(kSamples.begin(), kSamples.begin() + 40));
}

TEST(Tiff, RefusesPagesThatDiffer) {
  const TempFolder folder;
  const auto with_second = [&](const TiffPage& second) {
    TIFF* tiff = TIFFOpen((folder / "a.tif").c_str(), "w");
    write_page(tiff, {}, std::string(40, 'x'));
    write_page(tiff, second, std::string(80, 'x'));
    TIFFClose(tiff);
    return refusal(folder / "a.tif");
  };
  EXPECT_TRUE(contains(with_second({5, 5}), "expected 5 x 4 uint16 on page 1 as on page 0, found 5 x 5 uint16"));
  TiffPage other;
  other.format = SAMPLEFORMAT_INT;
  EXPECT_TRUE(contains(with_second(other), "found 5 x 4 int16"));
}

TEST(Tiff, RefusesSizesThatLie) {
  const TempFolder folder;
  HandMade page;
  page.height = 400000000;
  EXPECT_TRUE(contains(refusal(folder.put("a.tif", hand_made(page, std::string(40, 'x')))), "expected"));
  page = {};
  EXPECT_TRUE(contains(refusal(folder.put("a.tif", hand_made(page, std::string(39, 'x')))), "40 bytes of samples"));
  page.compression = COMPRESSION_PACKBITS;
  page.strip_bytes = 40;
  page.width = 1 << 30;
  EXPECT_TRUE(contains(refusal(folder.put("a.tif", hand_made(page, std::string(40, 'x')))), "cannot hold them"));
}

TEST(Tiff, SurvivesCutsAndFlips) {
  const TempFolder folder;
  for (const std::uint32_t tile : {0U, 16U}) {
    TiffPage page = described("ImageJ=1.53q\nimages=6\nslices=6\nunit=mm\nspacing=2\n");
    page.tile = tile;
    page.compression = COMPRESSION_LZW;
    const std::string content = get(write_stack(folder / "w.tif", page, stored(kSamples)));
    expect_prefixes_are_safe(folder, "a.tif", content);
    expect_flips_are_safe(folder, "a.tif", content, content.size());
  }
  HandMade page;
  page.description = "ImageJ=1.53q\nimages=6\nspacing=2\n";
  const std::string content = hand_made(page, stored(kSamples, true));
  expect_prefixes_are_safe(folder, "a.tif", content);
  expect_flips_are_safe(folder, "a.tif", content, 200);
}

}  // namespace
}  // namespace isoweave::testing::volume_tiff_test
