#include "volume_helpers.hpp"

namespace isoweave::testing::volume_metaimage_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

// A header of int16 3 x 2 x 5 with further keys; each replaces the default line of the same name.
std::string header(const std::string& more, const std::string& data_file = "LOCAL") {
  std::string text;
  for (const std::string line :
       {"ObjectType = Image", "NDims = 3", "BinaryData = True", "BinaryDataByteOrderMSB = False", "DimSize = 3 2 5",
        "ElementSpacing = 1 1 1", "ElementType = MET_SHORT"}) {
    const std::string key = line.substr(0, line.find(" ="));
    if (!contains("\n" + more, "\n" + key + " =")) text += line + "\n";
  }
  return text + more + "ElementDataFile = " + data_file + "\n";
}

std::string attached(const std::string& more = "") { return header(more) + stored(kSamples); }

VolumeInfo info_of(const TempFolder& folder, const std::string& more) {
  return open_volume(folder.put("a.mha", attached(more)))->info();
}

std::string refusal_of(const TempFolder& folder, const std::string& more) {
  return refusal(folder.put("a.mha", attached(more)));
}

TEST(MetaImage, ReadsBothByteOrdersPlainAndCompressed) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    const std::string order = std::string(" = ") + (big ? "True\n" : "False\n");
    const std::string data = stored(kSamples, big);
    const auto source = open_volume(folder.put("a.mha", header("BinaryDataByteOrderMSB" + order) + data));
    EXPECT_EQ(source->info().format, "metaimage");
    EXPECT_EQ(source->info().geometry.space, Space::kLps);
    EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
    const std::string packed = header("BinaryDataByteOrderMSB" + order + "CompressedData = True\n") + zlibbed(data);
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.mha", packed)), kSamples);
  }
}

TEST(MetaImage, IsToldByItsContentOrItsName) {
  const TempFolder folder;
  EXPECT_EQ(read_file<std::int16_t>(folder.put("no-ending", attached())), kSamples);
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.mhd", "Modality = MET_MOD_CT\n" + attached())), kSamples);
  EXPECT_TRUE(contains(refusal(folder.put("b", "Modality = MET_MOD_CT\n" + attached())), "NRRD, MetaImage"));
  EXPECT_TRUE(contains(refusal(folder.put("a.mha", "\x01\x02\x03")), "'Key = value'"));
  EXPECT_TRUE(contains(refusal(folder.put("a.mha", "NDims = 3\n")), "ElementDataFile"));
}

TEST(MetaImage, ReadsDetachedFilesWithTheirHeaders) {
  const TempFolder folder;
  const std::string data = stored(kSamples);
  folder.put("plain.raw", data);
  folder.put("headed.raw", "abcde" + data);
  folder.put("packed.zraw", zlibbed(data));
  folder.put("headed.zraw", "abcde" + zlibbed(data));
  const auto reads = [&](const std::string& more, const std::string& file) {
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.mhd", header(more, file))), kSamples) << file << " " << more;
  };
  reads("", "plain.raw");
  reads("HeaderSize = 5\n", "headed.raw");
  reads("HeaderSize = -1\n", "headed.raw");
  reads("CompressedData = True\n", "packed.zraw");
  reads("CompressedData = True\nHeaderSize = 5\n", "headed.zraw");
  const std::string size = std::to_string(zlibbed(data).size());
  reads("CompressedData = True\nHeaderSize = -1\nCompressedDataSize = " + size + "\n", "headed.zraw");
  const std::string lost = header("CompressedData = True\nHeaderSize = -1\n", "headed.zraw");
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", lost)), "CompressedDataSize"));
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", header("HeaderSize = -2\n", "headed.raw"))), "HeaderSize"));
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", header("HeaderSize = 6\n", "headed.raw"))), "60 bytes of samples"));
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", header("", "gone.raw"))),
                       "a.mhd: expected its samples in " + folder / "gone.raw" + ", found no such file"));
  const std::string long_name(3000, 'n');
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", header("", long_name))),
                       "a.mhd: expected its samples in a file, found a name that is too long for one, of " +
                           std::to_string((folder / long_name).size()) + " bytes: 'nnn"));
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", header("", ""))), "behind ElementDataFile, found nothing"));
}

TEST(MetaImage, ReadsSeriesOfFiles) {
  const TempFolder folder;
  const std::string data = stored(kSamples);
  std::string list = "LIST";
  for (std::size_t slice = 0; slice < 5; ++slice) {
    folder.put("p0" + std::to_string(slice + 1), data.substr(slice * 12, 12));
    list += "\np0" + std::to_string(slice + 1);
  }
  for (const std::string& file : {list, std::string("p%02d 1 5 1"), std::string("p%02d 1 5")}) {
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.mhd", header("", file))), kSamples) << file;
  }
  EXPECT_TRUE(contains(refusal(folder.put("a.mhd", header("", "p%02d 1 6 1"))), "p06, found no such file"));
}

TEST(MetaImage, TakesAxesOneAfterAnother) {
  const TempFolder folder;
  for (const std::string origin : {"Offset", "Position", "Origin"}) {
    for (const std::string matrix : {"TransformMatrix", "Rotation", "Orientation"}) {
      const Geometry geometry = info_of(folder, matrix + " = 0 1 0 -1 0 0 0 0 1\n" + origin +
                                                    " = 10 20 30\nElementSpacing = 2 3 4\nDistanceUnits = um\n")
                                    .geometry;
      EXPECT_EQ(geometry.spacing, (std::array<double, 3>{2, 3, 4}));
      EXPECT_EQ(geometry.origin, (std::array<double, 3>{10, 20, 30}));
      EXPECT_EQ(geometry.direction, (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
      EXPECT_EQ(geometry.unit, "um");
    }
  }
}

TEST(MetaImage, TakesElementSizeOnlyWithoutSpacing) {
  const TempFolder folder;
  EXPECT_EQ(info_of(folder, "ElementSize = 9 9 9\nElementSpacing = 2 3 4\n").geometry.spacing[0], 2);
  std::string content = attached("ElementSize = 2 3 4\n");
  content.erase(content.find("ElementSpacing"), std::string("ElementSpacing = 1 1 1\n").size());
  EXPECT_EQ(open_volume(folder.put("a.mha", content))->info().geometry.spacing[2], 4);
}

TEST(MetaImage, RefusesWrongGeometry) {
  const TempFolder folder;
  for (const std::string line : {"ElementSpacing = 0 1 1", "ElementSpacing = 1 nan 1", "ElementSpacing = 1 inf 1",
                                 "ElementSpacing = 1 1", "ElementSpacing = 1 1 x", "Offset = 0 0 nan", "Offset = 0 0",
                                 "TransformMatrix = 1 0 0 1 0 0 0 0 1", "TransformMatrix = 1 0 0 0 1 0"}) {
    EXPECT_TRUE(contains(refusal_of(folder, line + "\n"), "expected")) << line;
  }
}

TEST(MetaImage, KnowsAllScalarTypesAndNamesTheOthers) {
  const TempFolder folder;
  const std::vector<std::pair<std::string, SampleType>> types{
      {"MET_CHAR", SampleType::kInt8},       {"MET_UCHAR", SampleType::kUint8},       {"MET_SHORT", SampleType::kInt16},
      {"MET_USHORT", SampleType::kUint16},   {"MET_INT", SampleType::kInt32},         {"MET_UINT", SampleType::kUint32},
      {"MET_LONG_LONG", SampleType::kInt64}, {"MET_ULONG_LONG", SampleType::kUint64}, {"MET_LONG", SampleType::kInt32},
      {"MET_FLOAT", SampleType::kFloat32},   {"MET_DOUBLE", SampleType::kFloat64}};
  for (const auto& [name, type] : types) {
    const std::string content = header("ElementType = " + name + "\n") + std::string(30 * sample_bytes(type), 'x');
    EXPECT_EQ(open_volume(folder.put("a.mha", content))->info().type, type) << name;
  }
  for (const std::string name : {"MET_LONG_LONG_ARRAY", "MET_UCHAR_ARRAY", "MET_STRING", ""}) {
    EXPECT_TRUE(contains(refusal_of(folder, "ElementType = " + name + "\n"), "'" + name + "'")) << name;
  }
}

TEST(MetaImage, RefusesOtherKindsOfContent) {
  const TempFolder folder;
  EXPECT_TRUE(contains(refusal_of(folder, "ElementNumberOfChannels = 3\n"), "found 3 channels"));
  EXPECT_TRUE(contains(refusal_of(folder, "ObjectType = Tube\n"), "'Tube'"));
  EXPECT_TRUE(contains(refusal_of(folder, "BinaryData = False\n"), "BinaryData"));
  EXPECT_EQ(info_of(folder, "ElementNumberOfChannels = 1\n").dims[0], 3);
}

TEST(MetaImage, AcceptsFurtherAxesOfOneSampleOnly) {
  const TempFolder folder;
  const std::string four = "ElementSpacing = 2 3 4 1\nNDims = 4\n";
  const VolumeInfo info = info_of(folder, four + "DimSize = 3 2 5 1\n");
  EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{2, 3, 4}));
  EXPECT_TRUE(contains(refusal_of(folder, "NDims = 5\nElementSpacing = 2 3 4 1 1\nDimSize = 3 2 1 1 5\n"),
                       "axis 4 with 5 samples"));
  EXPECT_EQ(info_of(folder, "NDims = 2\nDimSize = 6 5\nElementSpacing = 1 2\n").dims[2], 1);
}

TEST(MetaImage, ChoosesATimeAndAChannel) {
  const TempFolder folder;
  const std::string lines = "NDims = 4\nDimSize = 3 2 1 2\nElementSpacing = 2 3 4 1\nElementNumberOfChannels = 2\n";
  const auto samples = ramp<std::int16_t>(24);
  const std::string path = folder.put("a.mha", header(lines) + stored(samples));
  OpenOptions options;
  for (std::size_t choice = 0; choice < 4; ++choice) {
    options.channel = static_cast<std::int64_t>(choice % 2);
    options.time = static_cast<std::int64_t>(choice / 2);
    const auto read = read_file<std::int16_t>(path, options);
    for (std::size_t n = 0; n < 6; ++n) EXPECT_EQ(read.at(n), samples[choice % 2 + 2 * n + 12 * (choice / 2)]);
  }
  options.time = 2;
  EXPECT_TRUE(contains(refusal(path, options), "expected --time below 2, found 2"));
  const VolumeInfo first = info_of(folder, "NDims = 4\nDimSize = 3 2 1 5\nElementSpacing = 2 3 4 1\n");
  EXPECT_TRUE(contains(first.notes.at(0), "the first of 5 along time is read"));
}

TEST(MetaImage, ContradictionsAreTold) {
  const TempFolder folder;
  EXPECT_TRUE(info_of(folder, "ElementSize = 2 3 4\nElementSpacing = 2 3 4\n").notes.empty());
  EXPECT_EQ(info_of(folder, "ElementSize = 2 3 9\nElementSpacing = 2 3 4\n").notes.at(0),
            "the spacing of axis 2 is 4 by ElementSpacing, which is taken, and 9 by ElementSize");
  const std::string packed = zlibbed(stored(kSamples));
  const auto notes = [&](std::size_t said) {
    const std::string lines = "CompressedData = True\nCompressedDataSize = " + std::to_string(said) + "\n";
    const auto source = open_volume(folder.put("a.mha", header(lines) + packed));
    EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
    return source->info().notes;
  };
  EXPECT_TRUE(notes(packed.size()).empty());
  EXPECT_TRUE(contains(notes(7).at(0), "CompressedDataSize is 7, and the file has " + std::to_string(packed.size())));
}

TEST(MetaImage, IntensitiesAreToldAndNotApplied) {
  const TempFolder folder;
  const std::string slope = "ElementToIntensityFunctionSlope = ", offset = "ElementToIntensityFunctionOffset = ";
  const VolumeInfo scaled = info_of(folder, slope + "2\n" + offset + "-5\n");
  EXPECT_EQ(scaled.slope, 1);
  ASSERT_EQ(scaled.notes.size(), 1U);
  EXPECT_TRUE(contains(scaled.notes[0], "scales samples to intensities by 2 and -5 (ElementToIntensityFunction)"));
  const VolumeInfo moved = info_of(folder, offset + "3\n");
  ASSERT_EQ(moved.notes.size(), 1U);
  EXPECT_TRUE(contains(moved.notes[0], "by 1 and 3 ("));
  EXPECT_TRUE(info_of(folder, slope + "1\n" + offset + "0\n").notes.empty());
}

TEST(MetaImage, BytesBehindTheSamplesAreTold) {
  const TempFolder folder;
  EXPECT_EQ(info_of(folder, "DimSize = 3 2 3\nElementSpacing = 1 1 1\n").notes.at(0),
            "24 bytes behind the samples that the header describes are not read");
}

TEST(MetaImage, TakesOtherUnits) {
  const TempFolder folder;
  const Geometry geometry = info_of(folder, "Offset = 1 2 3\nElementSpacing = 2 3 4\nDistanceUnits = cm\n").geometry;
  EXPECT_EQ(geometry.spacing, (std::array<double, 3>{20, 30, 40}));
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(geometry.unit, "mm");
  EXPECT_TRUE(info_of(folder, "ElementSpacing = 2 3 4\nDistanceUnits = ?\n").notes.empty());
}

TEST(MetaImage, RefusesHeadersThatLie) {
  const TempFolder folder;
  for (const std::string line :
       {"DimSize = 3 2 6", "DimSize = 0 2 5", "DimSize = 3 -2 5", "DimSize = 3 2", "DimSize = 3 2 x",
        "DimSize = 4294967296 4294967296 4294967296", "DimSize = 3000000 3000000 300000", "NDims = 0", "NDims = -1",
        "NDims = 99", "NDims = x"}) {
    EXPECT_TRUE(contains(refusal_of(folder, line + "\n"), "expected")) << line;
    const std::string packed = header(line + "\nCompressedData = True\n") + zlibbed(stored(kSamples));
    EXPECT_TRUE(contains(refusal(folder.put("a.mha", packed)), "expected")) << line;
  }
}

TEST(MetaImage, SurvivesEveryTruncation) {
  const TempFolder folder;
  expect_prefixes_are_safe(folder, "a.mha", attached("Offset = 1 2 3\n"));
  expect_prefixes_are_safe(folder, "b.mha", header("CompressedData = True\n") + zlibbed(stored(kSamples)));
  folder.put("d", stored(kSamples));
  expect_prefixes_are_safe(folder, "c.mhd", header("HeaderSize = -1\n", "d"));
}

TEST(MetaImage, SurvivesRandomChanges) {
  const TempFolder folder;
  const std::string plain = header("TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 1 2 3\n");
  expect_flips_are_safe(folder, "a.mha", plain + stored(kSamples), plain.size());
  const std::string packed = header("CompressedData = True\n");
  expect_flips_are_safe(folder, "b.mha", packed + zlibbed(stored(kSamples)), packed.size() + 40);
}

}  // namespace
}  // namespace isoweave::testing::volume_metaimage_test
