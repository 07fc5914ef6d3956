#include <cmath>

#include "volume_helpers.hpp"

namespace isoweave::testing::volume_nrrd_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

// A header of int16 3 x 2 x 5 with further fields; each replaces the default line of the same name.
std::string header(const std::string& more = "", const std::string& version = "NRRD0004") {
  std::string text = version + "\n# a comment\n";
  for (const std::string line : {"type: short", "dimension: 3", "sizes: 3 2 5", "endian: little", "encoding: raw"}) {
    const std::string name = line.substr(0, line.find(':') + 1);
    if (!contains("\n" + more, "\n" + name)) text += line + "\n";
  }
  return text + more;
}

std::string numbered(std::string stem, int number) {
  stem += std::to_string(number);
  return stem;
}

std::string attached(const std::string& more = "") { return header(more) + "\n" + stored(kSamples); }

VolumeInfo info_of(const TempFolder& folder, const std::string& more) {
  return open_volume(folder.put("a.nrrd", attached(more)))->info();
}

std::string refusal_of(const TempFolder& folder, const std::string& more) {
  return refusal(folder.put("a.nrrd", attached(more)));
}

TEST(Nrrd, ReadsEveryVersion) {
  const TempFolder folder;
  for (const char* version : {"NRRD0001", "NRRD0002", "NRRD0003", "NRRD0004", "NRRD0005"}) {
    const auto source = open_volume(folder.put("a.nrrd", header("", version) + "\n" + stored(kSamples)));
    EXPECT_EQ(source->info().format, "nrrd");
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
    EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples) << version;
  }
  EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", header("", "NRRD0006") + "\n")), "found 'NRRD0006'"));
  EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", "NRRD")), "found 'NRRD'"));
}

TEST(Nrrd, ReadsBothByteOrdersPlainAndGzip) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    const std::string endian = big ? "endian: big\n" : "endian: little\n";
    const std::string data = stored(kSamples, big);
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", header(endian) + "\n" + data)), kSamples);
    for (const std::string name : {"gzip", "gz", "GZip"}) {
      const std::string content = header(endian + "encoding: " + name + "\n") + "\n" + gzipped(data);
      EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", content)), kSamples) << name;
    }
  }
  EXPECT_TRUE(contains(refusal_of(folder, "endian: middle\n"), "endian 'little' or 'big'"));
}

TEST(Nrrd, ReadsLinesEndedByCarriageReturns) {
  const TempFolder folder;
  std::string text = header("spacings: 2 3 4\n");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", text + "\r\n" + stored(kSamples))), kSamples);
}

TEST(Nrrd, KnowsAllTypeNamesAndNamesTheOthers) {
  const TempFolder folder;
  const std::vector<std::pair<std::string, SampleType>> types{
      {"signed char", SampleType::kInt8},    {"uchar", SampleType::kUint8},
      {"unsigned char", SampleType::kUint8}, {"uint8_t", SampleType::kUint8},
      {"short int", SampleType::kInt16},     {"unsigned short", SampleType::kUint16},
      {"int32", SampleType::kInt32},         {"unsigned int", SampleType::kUint32},
      {"float", SampleType::kFloat32},       {"double", SampleType::kFloat64},
      {"long long", SampleType::kInt64},     {"int64_t", SampleType::kInt64},
      {"ulonglong", SampleType::kUint64},    {"unsigned long long int", SampleType::kUint64}};
  for (const auto& [name, type] : types) {
    const std::string content = header("type: " + name + "\n") + "\n" + std::string(30 * sample_bytes(type), 'x');
    EXPECT_EQ(open_volume(folder.put("a.nrrd", content))->info().type, type) << name;
  }
  for (const std::string name : {"long", "unsigned long", "block", "half"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "type: " + name + "\n"), "type '" + name + "'")) << name;
  }
  EXPECT_TRUE(contains(refusal_of(folder, "type: \n"), "expected the field 'type', found none"));
}

TEST(Nrrd, RefusesEncodingsItDoesNotKnow) {
  const TempFolder folder;
  for (const std::string name : {"bzip2", "bz2", "zrl"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "encoding: " + name + "\n"),
                         "expected encoding raw, gzip, ascii or hex, found '" + name + "'"));
  }
}

TEST(Nrrd, SkipsLinesAndBytes) {
  const TempFolder folder;
  const std::string data = stored(kSamples);
  const auto reads = [&](const std::string& more, const std::string& behind) {
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", header(more) + "\n" + behind)), kSamples) << more;
  };
  reads("line skip: 2\nbyte skip: 3\n", "one\ntwo\nabc" + data);
  reads("byte skip: -1\n", "anything" + data);
  reads("byte skip: -5\n", "anything" + data + "tail");
  reads("lineskip: 1\nencoding: gzip\n", "one\n" + gzipped(data));
  reads("byteskip: 4\nencoding: gzip\n", gzipped("abcd" + data));
  reads("byte skip: -1\nencoding: gzip\n", gzipped("anything" + data));
  reads("byte skip: -5\nencoding: gzip\n", gzipped("anything" + data + "tail"));
  reads("byte skip:=7\n", data);
}

TEST(Nrrd, RefusesSkipsThatLeaveTooLittle) {
  const TempFolder folder;
  for (const std::string skip :
       {"byte skip: 1", "byte skip: 9223372036854775807", "byte skip: -2", "byte skip: -9223372036854775808",
        "line skip: 1000", "line skip: -1", "byte skip: ten", "byte skip: 99999999999999999999"}) {
    EXPECT_TRUE(contains(refusal_of(folder, skip + "\n"), "expected")) << skip;
    const std::string packed = header(skip + "\nencoding: gzip\n") + "\n" + gzipped(stored(kSamples));
    EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", packed)), "expected")) << skip;
  }
}

TEST(Nrrd, ReadsDetachedDataBesideTheHeader) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "sub");
  folder.put("sub/the data.raw", stored(kSamples));
  for (const std::string field : {"data file: sub/the data.raw", "datafile: ./sub/the data.raw"}) {
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nhdr", header(field + "\n"))), kSamples) << field;
    // Fields may follow the data file, and a line end may be missing.
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nhdr", header(field + "\nspacings: 1 1 1"))), kSamples);
  }
  EXPECT_TRUE(contains(refusal(folder.put("a.nhdr", header("data file: gone.raw\n"))),
                       "a.nhdr: expected its samples in " + folder / "gone.raw" + ", found no such file"));
  folder.put("short.raw", "xx");
  EXPECT_TRUE(contains(refusal(folder.put("a.nhdr", header("data file: short.raw\n"))), "60 bytes of samples"));
  EXPECT_TRUE(contains(refusal(folder.put("a.nhdr", header())), "a blank line behind the header, or a data file"));
}

TEST(Nrrd, ReadsSeriesOfFiles) {
  const TempFolder folder;
  const std::string data = stored(kSamples);
  std::string list;
  for (int slice = 0; slice < 5; ++slice) {
    const std::string part = data.substr(static_cast<std::size_t>(slice) * 12, 12);
    folder.put("p00" + std::to_string(2 * slice + 1) + ".raw", part);
    folder.put(numbered("z", slice) + ".gz", gzipped("skip" + part));
    list += "p00" + std::to_string(2 * slice + 1) + ".raw\n";
  }
  for (const std::string& file : {std::string("LIST\n") + list, "LIST 2\n" + list, std::string("p%03d.raw 1 9 2\n"),
                                  std::string("p%03d.raw 1 9 2 2\n")}) {
    const std::string path = folder.put("a.nhdr", header("data file: " + file));
    EXPECT_EQ(read_file<std::int16_t>(path), kSamples) << file;
    const auto source = open_volume(path);
    std::vector<std::int16_t> slice(6);
    source->read(3, 1, std::as_writable_bytes(std::span(slice)));
    EXPECT_TRUE(std::equal(slice.begin(), slice.end(), kSamples.begin() + 18)) << file;
  }
  const std::string packed = "encoding: gzip\nbyte skip: 4\ndata file: z%d.gz 0 4 1\n";
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nhdr", header(packed))), kSamples);
  std::vector<std::int16_t> backwards =
      read_file<std::int16_t>(folder.put("a.nhdr", header("data file: p%03d.raw 9 1 -2\n")));
  EXPECT_TRUE(std::equal(backwards.begin(), backwards.begin() + 6, kSamples.begin() + 24));
}

TEST(Nrrd, SkipsWithinFilesOfSeveralSlices) {
  const TempFolder folder;
  const auto samples = ramp<std::uint8_t>(2 * 2 * 12);
  const std::string data = stored(samples);
  for (std::size_t part = 0; part < 3; ++part)
    folder.put(numbered("p", static_cast<int>(part)), data.substr(part * 16, 16));
  const std::string text = header("type: uchar\nsizes: 2 2 12\ndata file: p%d 0 2 1\n");
  for (std::int64_t first = 0; first < 12; ++first) {
    for (std::int64_t second = first + 1; second < 12; ++second) {
      const auto source = open_volume(folder.put("a.nhdr", text));
      std::vector<std::byte> slice(4);
      source->read(first, 1, slice);
      source->read(second, 1, slice);
      EXPECT_EQ(std::to_integer<std::uint8_t>(slice[0]), samples[static_cast<std::size_t>(second) * 4]);
    }
  }
}

TEST(Nrrd, RefusesSeriesThatDoNotFit) {
  const TempFolder folder;
  for (int n = 0; n < 5; ++n) folder.put(numbered("p", n), std::string(12, 'x'));
  for (const std::string file :
       {"p%d 0 6 1", "p%d 0 3 1", "p%d 0 4 0", "p%d 4 0 1", "p%d 0 9223372036854775807 1", "p%s 0 4 1", "p%d%d 0 4 1",
        "p%999999d 0 4 1", "p%n 0 4 1", "p% 0 4 1", "LIST", "LIST\np0\np1\np2", "LIST\np0\np1\np2\np3\nq4"}) {
    const std::string message = refusal(folder.put("a.nhdr", header("data file: " + file + "\n")));
    EXPECT_TRUE(contains(message, "expected")) << file << ": " << message;
  }
  // A missing file is found before anything is read.
  EXPECT_THROW(open_volume(folder.put("a.nhdr", header("data file: LIST\np0\np1\np2\np3\nq4\n"))), BadInput);
  folder.put("p2", std::string(11, 'x'));
  EXPECT_TRUE(contains(refusal(folder.put("a.nhdr", header("data file: p%d 0 4 1\n"))), "p2: expected 12 bytes"));
}

TEST(Nrrd, TakesSpacings) {
  const TempFolder folder;
  VolumeInfo info = info_of(folder, "spacings: 0.5 nan 2e-1\naxis mins: 1 nan 3\ncenters: node cell cell\n");
  EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.5, 1, 0.2}));
  EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{1, 0, 3.1}));
  EXPECT_EQ(info.geometry.space, Space::kUnknown);
  EXPECT_EQ(info.notes.size(), 1u);
  info = info_of(folder, "spacings: 1 1 -2\n");
  EXPECT_EQ(info.geometry.spacing[2], 2);
  EXPECT_EQ(info.geometry.direction[8], -1);
  for (const std::string wrong : {"0 1 1", "1 1", "1 1 inf", "1 1 1 1", "1 1 x"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "spacings: " + wrong + "\n"), "expected")) << wrong;
  }
}

TEST(Nrrd, TakesSpacingsFromTheEndsOfAxes) {
  const TempFolder folder;
  const Geometry geometry =
      info_of(folder, "axis mins: 1 1 nan\naxis maxs: 7 2 nan\ncenters: cell node cell\nspacings: nan nan 3\n")
          .geometry;
  EXPECT_EQ(geometry.spacing, (std::array<double, 3>{2, 1, 3}));
  EXPECT_EQ(geometry.origin, (std::array<double, 3>{2, 1, 0}));
}

TEST(Nrrd, TakesDirectionsOfTheSpace) {
  const TempFolder folder;
  const std::string axes = "space directions: (0,2,0) (-3, 0, 0) ( 0,0,4 )\nspace origin: (1,2,3)\n";
  for (const std::string name : {"left-posterior-superior", "LPS"}) {
    const Geometry lps = info_of(folder, "space: " + name + "\n" + axes).geometry;
    EXPECT_EQ(lps.space, Space::kLps);
    EXPECT_EQ(lps.spacing, (std::array<double, 3>{2, 3, 4}));
    EXPECT_EQ(lps.direction, (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
    EXPECT_EQ(lps.origin, (std::array<double, 3>{1, 2, 3}));
  }
  const Geometry ras = info_of(folder, "space: Right-Anterior-Superior\n" + axes).geometry;
  EXPECT_EQ(ras.space, Space::kRas);
  EXPECT_EQ(ras.direction, (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
  const Geometry las = info_of(folder, "space: LAS\n" + axes).geometry;
  EXPECT_EQ(las.space, Space::kLps);
  EXPECT_EQ(las.direction, (std::array<double, 9>{0, -1, 0, -1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(las.origin, (std::array<double, 3>{1, -2, 3}));
  const VolumeInfo scanner = info_of(folder, "space: scanner-xyz\n" + axes);
  EXPECT_EQ(scanner.geometry.space, Space::kUnknown);
  EXPECT_TRUE(contains(scanner.notes.at(0), "scanner-xyz"));
}

TEST(Nrrd, RefusesDirectionsThatSpanNothing) {
  const TempFolder folder;
  for (const std::string wrong :
       {"(1,0,0) (2,0,0) (0,0,1)", "(0,0,0) (0,1,0) (0,0,1)", "(1,0,0) (0,nan,0) (0,0,1)", "(1,0,0) (0,inf,0) (0,0,1)",
        "(1,0,0) (0,1,0)", "(1,0,0) (0,1,0) (0,0,1", "(1,0,0,0,0) (0,1,0,0,0) (0,0,1,0,0)", "1 0 0"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "space: LPS\nspace directions: " + wrong + "\n"), "expected")) << wrong;
  }
  EXPECT_TRUE(contains(refusal_of(folder, "space: LPS\nspace directions: (0,0,0) (0,1,0) (0,0,1)\n"),
                       "expected a positive, finite sample spacing on axis 0 by the space directions, found 0"));
  const std::string axes = "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
  EXPECT_TRUE(contains(refusal_of(folder, axes + "space origin: (0,nan,0)\n"), "origin"));
}

TEST(Nrrd, TakesUnitsOfTheAxesOrTheWorld) {
  const TempFolder folder;
  EXPECT_EQ(info_of(folder, "units: \"mm\" \"mm\" \"mm\"\n").geometry.unit, "mm");
  EXPECT_EQ(info_of(folder, "units: nm nm nm\n").geometry.unit, "nm");
  EXPECT_EQ(info_of(folder, "space units: \"microns\" \"microns\" \"microns\"\n").geometry.unit, "um");
  const VolumeInfo plain =
      info_of(folder, "spacings: 0.5 1 0.05\naxis mins: 0 0 1\ncenters: node node node\nunits: \"nm\" \"nm\" \"um\"\n");
  EXPECT_EQ(plain.geometry.spacing, (std::array<double, 3>{0.5, 1, 50}));
  EXPECT_EQ(plain.geometry.origin[2], 1000);
  EXPECT_EQ(plain.geometry.unit, "nm");
  const std::string axes = "space: LPS\nspace directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (1,2,3)\n";
  EXPECT_EQ(info_of(folder, axes + "space units: \"cm\" \"cm\" \"cm\"\n").geometry.spacing[2], 40);
  // Units of the world's axes, of which the second is the first of the file.
  const Geometry turned = info_of(folder, axes + "space units: \"mm\" \"um\" \"mm\"\n").geometry;
  EXPECT_EQ(turned.spacing, (std::array<double, 3>{0.002, 3, 4}));
  EXPECT_EQ(turned.origin, (std::array<double, 3>{1, 0.002, 3}));
  EXPECT_EQ(turned.unit, "mm");
  EXPECT_TRUE(contains(refusal_of(folder, axes + "units: \"mm\" \"um\" \"mm\"\n"), "or --spacing"));
  EXPECT_EQ(info_of(folder, axes + "units: \"mm\" \"mm\" \"mm\"\n").geometry.unit, "mm");
  const VolumeInfo odd = info_of(folder, "space units: \"ell\" \"ell\" \"ell\"\n");
  EXPECT_EQ(odd.geometry.unit, "");
  EXPECT_TRUE(contains(odd.notes.back(), "the unit 'ell' is no length"));
  EXPECT_TRUE(contains(refusal_of(folder, "space units: \"mm\" \"mm\" \"ell\"\n"), "found 'mm', 'mm', 'ell'"));
}

TEST(Nrrd, BytesBehindTheSamplesAreTold) {
  const TempFolder folder;
  const std::string fields = "spacings: 1 1 1\n";
  EXPECT_TRUE(info_of(folder, fields).notes.empty());
  const VolumeInfo half = info_of(folder, fields + "sizes: 3 2 2\n");
  EXPECT_EQ(half.notes.at(0), "36 bytes behind the samples that the header describes are not read");
  folder.put("d.raw", "ab\ncd" + stored(kSamples) + "x");
  const std::string detached = header(fields + "line skip: 1\nbyte skip: 2\ndata file: d.raw\n");
  EXPECT_EQ(open_volume(folder.put("a.nhdr", detached))->info().notes.at(0).substr(0, 8), "1 bytes ");
}

TEST(Nrrd, SpacingsBesideDirectionsAreTold) {
  const TempFolder folder;
  const std::string axes = "space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n";
  EXPECT_TRUE(info_of(folder, axes + "spacings: 2 3 4\n").notes.empty());
  const VolumeInfo info = info_of(folder, axes + "spacings: 2 3 5\n");
  EXPECT_EQ(info.geometry.spacing[2], 4);
  EXPECT_EQ(info.notes.at(0), "the spacing of axis 2 is 4 by its space direction, which is taken, and 5 by spacings");
}

// Sample (list, x, y, z, time) = (l, i, j, k, t) of sizes 2, 3, 2, 5, 2.
TEST(Nrrd, ChoosesAlongListsAndTimes) {
  const TempFolder folder;
  const auto samples = ramp<std::int16_t>(2 * 30 * 2);
  const std::string fields =
      header("dimension: 5\nsizes: 2 3 2 5 2\nkinds: list domain domain domain time\nspacings: nan 2 3 4 nan\n");
  const std::string packed = header(
      "dimension: 5\nsizes: 2 3 2 5 2\nkinds: list domain domain domain time\nencoding: gzip\nspacings: nan 2 3 4 "
      "nan\n");
  for (const std::string& path : {folder.put("a.nrrd", fields + "\n" + stored(samples)),
                                  folder.put("b.nrrd", packed + "\n" + gzipped(stored(samples)))}) {
    const VolumeInfo first = open_volume(path)->info();
    EXPECT_EQ(first.dims, (std::array<std::int64_t, 3>{3, 2, 5}));
    EXPECT_EQ(first.geometry.spacing, (std::array<double, 3>{2, 3, 4}));
    EXPECT_EQ(first.notes.size(), 2U);
    for (std::size_t choice = 0; choice < 4; ++choice) {
      OpenOptions options;
      options.channel = static_cast<std::int64_t>(choice % 2);
      options.time = static_cast<std::int64_t>(choice / 2);
      const auto source = open_volume(path, options);
      const auto read = samples_of<std::int16_t>(*source, 1);
      for (std::size_t n = 0; n < 30; ++n) {
        EXPECT_EQ(read[n], samples[choice % 2 + 2 * n + 60 * (choice / 2)]) << choice;
      }
      const auto skipped = open_volume(path, options);
      std::vector<std::int16_t> slice(6);
      skipped->read(4, 1, std::as_writable_bytes(std::span(slice)));
      EXPECT_TRUE(std::equal(slice.begin(), slice.end(), read.begin() + 24));
    }
    OpenOptions options;
    options.channel = 2;
    EXPECT_TRUE(contains(refusal(path, options), "expected --channel below 2, found 2"));
  }
}

TEST(Nrrd, AnAxisWithoutADirectionIsThatOfChannels) {
  const TempFolder folder;
  const std::string axes = "space: LPS\nspace directions: (2,0,0) none (0,3,0)\n";
  const VolumeInfo flat = info_of(folder, axes);
  EXPECT_EQ(flat.dims, (std::array<std::int64_t, 3>{3, 5, 1}));
  EXPECT_TRUE(contains(flat.notes.at(0), "--slices-from channel takes them for slices"));
  OpenOptions options;
  options.channel = 1;
  const auto second = read_file<std::int16_t>(folder / "a.nrrd", options);
  EXPECT_EQ(second.at(0), kSamples.at(3));
  EXPECT_EQ(second.at(3), kSamples.at(9));
  options = {};
  options.slices_from = SliceAxis::kChannels;
  EXPECT_TRUE(contains(refusal(folder / "a.nrrd", options), "expected slices that lie behind one another"));
  const auto deep =
      open_volume(folder.put("b.nrrd", attached("space: LPS\nspace directions: (2,0,0) (0,3,0) none\n")), options);
  EXPECT_EQ(samples_of<std::int16_t>(*deep), kSamples);
  EXPECT_EQ(deep->info().geometry.spacing, (std::array<double, 3>{2, 3, 1}));
  EXPECT_EQ(deep->info().geometry.direction[8], 1);
  EXPECT_TRUE(contains(deep->info().notes.at(0), "taken as 1"));
}

TEST(Nrrd, TheFourthAxisOfSpaceIsTime) {
  const TempFolder folder;
  const std::string axes =
      "dimension: 4\nspace dimension: 4\nspace directions: (2,0,0,0) (0,3,0,0) (0,0,4,0) (0,0,0,1)\nspace origin: "
      "(1,2,3,0)\n";
  const VolumeInfo one = info_of(folder, axes + "sizes: 3 2 5 1\n");
  EXPECT_EQ(one.dims, (std::array<std::int64_t, 3>{3, 2, 5}));
  EXPECT_EQ(one.geometry.spacing, (std::array<double, 3>{2, 3, 4}));
  EXPECT_EQ(one.geometry.origin, (std::array<double, 3>{1, 2, 3}));
  OpenOptions options;
  options.time = 1;
  const std::string several = header(axes + "sizes: 3 2 2 2\nspace: left-posterior-superior-time\n");
  const auto source = open_volume(folder.put("a.nrrd", several + "\n" + stored(kSamples)), options);
  EXPECT_EQ(source->info().geometry.space, Space::kLps);
  EXPECT_EQ(samples_of<std::int16_t>(*source).at(0), kSamples.at(12));
  EXPECT_TRUE(contains(refusal_of(folder,
                                  "dimension: 4\nsizes: 3 2 5 1\nspace directions: (2,0,0,1) (0,3,0,0) (0,0,4,0) "
                                  "(0,0,0,1)\n"),
                       "found one that lies in both"));
  // Without directions as well.
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", attached("dimension: 4\nsizes: 3 2 2 2\n")), options).at(0),
            kSamples.at(12));
  EXPECT_TRUE(contains(refusal_of(folder,
                                  "dimension: 5\nsizes: 2 2 2 2 2\nkinds: domain domain domain domain list\n"
                                  "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1) (1,1,0) (0,1,1)\n"),
                       "expected at most 4 dimensions"));
}

TEST(Nrrd, NumbersInTextAndHexadecimalDigits) {
  const TempFolder folder;
  std::string numbers, digits;
  for (const std::int16_t sample : kSamples) numbers += std::to_string(sample) + (sample % 2 == 0 ? " " : "\n");
  for (const char byte : stored(kSamples, true)) {
    constexpr std::string_view kDigits = "0123456789aBcDeF";
    digits += kDigits[static_cast<unsigned char>(byte) >> 4];
    digits += kDigits[static_cast<unsigned char>(byte) & 15];
    if (digits.size() % 7 == 0) digits += "\n";
  }
  for (const std::string name : {"ascii", "text", "txt", "ASCII"}) {
    const std::string content = header("encoding: " + name + "\n") + "\n" + numbers;
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", content)), kSamples) << name;
  }
  // Text has no order of bytes, and needs none.
  const std::string endless = "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 5\nencoding: text\n\n";
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", endless + numbers)), kSamples);
  // Commas stand before and behind numbers, where Teem passes over them. Inside they may be those of fractions.
  std::string commas = ",,";
  for (const std::int16_t sample : kSamples) commas += " " + std::to_string(sample) + (sample % 2 == 0 ? "," : " , ,");
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.nrrd", endless + commas)), kSamples);
  EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", endless + "1,5" + commas)),
                       "expected numbers of type int16, between blanks, found '1,5'"));
  const std::string hex = header("encoding: hex\nendian: big\n") + "\n" + digits;
  EXPECT_EQ(read_file<std::int16_t>(folder.put("b.nrrd", hex)), kSamples);
  folder.put("data.txt", "one line\n" + numbers);
  EXPECT_EQ(
      read_file<std::int16_t>(folder.put("c.nhdr", header("encoding: text\nline skip: 1\ndata file: data.txt\n"))),
      kSamples);
  EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", endless + numbers + "x")), "nothing was thrown"));
  EXPECT_TRUE(
      contains(refusal(folder.put("a.nrrd", endless + "1 2 x" + numbers)), "expected numbers of type int16, between"));
  EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", endless + "1 2 3")), "which cannot hold them"));
  EXPECT_TRUE(contains(refusal(folder.put("b.nrrd", header("encoding: hex\n") + "\nxy" + digits)), "'x'"));
  EXPECT_TRUE(
      contains(refusal_of(folder, "encoding: bzip2\n"), "expected encoding raw, gzip, ascii or hex, found 'bzip2'"));
  expect_prefixes_are_safe(folder, "b.nrrd", hex);
}

TEST(Nrrd, DropsAxesOfOneSampleAndRefusesOthers) {
  const TempFolder folder;
  const std::vector<std::string> good{
      "dimension: 4\nsizes: 1 3 2 5\nkinds: vector domain domain domain\nspacings: nan 2 3 4\n",
      "dimension: 4\nsizes: 3 2 5 1\nspacings: 2 3 4 1\n",
      "dimension: 4\nsizes: 3 2 5 1\nspace: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4) none\n",
      "dimension: 5\nsizes: 1 3 2 1 5\nspace: LPS\nspace directions: (nan,nan,nan) (2,0,0) (0,3,0) none (0,0,4)\n"};
  for (const std::string& fields : good) {
    const VolumeInfo info = info_of(folder, fields);
    EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{3, 2, 5})) << fields;
    EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{2, 3, 4})) << fields;
  }
  EXPECT_TRUE(contains(refusal_of(folder, "dimension: 4\nsizes: 3 1 2 5\nkinds: RGB-color domain domain domain\n"),
                       "axis 0 of kind 'rgb-color' with 3 values"));
  EXPECT_TRUE(contains(refusal_of(folder, "kinds: 3-vector domain domain\n"), "axis 0 of kind '3-vector'"));
}

TEST(Nrrd, ReadsPlaneImages) {
  const TempFolder folder;
  EXPECT_EQ(info_of(folder, "dimension: 2\nsizes: 6 5\n").dims, (std::array<std::int64_t, 3>{6, 5, 1}));
  const VolumeInfo info = info_of(folder, "dimension: 2\nsizes: 6 5\nspace: LPS\nspace directions: (0,2,0) (0,0,2)\n");
  EXPECT_EQ(info.geometry.direction, (std::array<double, 9>{0, 0, 1, 1, 0, 0, 0, 1, 0}));
}

TEST(Nrrd, RefusesHeadersThatLie) {
  const TempFolder folder;
  for (const std::string sizes : {"3 0 5", "3 -2 5", "3 2", "3 2 5 1", "3 2 x", "3 2 99999999999999999999",
                                  "4294967296 4294967296 4294967296", "3000000 3000000 300000", "3 2 6"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "sizes: " + sizes + "\n"), "expected")) << sizes;
    const std::string packed = header("encoding: gzip\nsizes: " + sizes + "\n") + "\n" + gzipped(stored(kSamples));
    EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", packed)), "expected")) << sizes;
  }
  for (const std::string dimension : {"0", "-3", "17", "x", "999999999999"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "dimension: " + dimension + "\n"), "expected")) << dimension;
  }
  EXPECT_TRUE(contains(refusal_of(folder, "nonsense\n"), "header lines 'field: value'"));
  EXPECT_TRUE(contains(refusal_of(folder, "byte skip: 0\nByte Skip: 0\n"), "twice"));
  EXPECT_TRUE(contains(refusal(folder.put("a.nrrd", "NRRD0004\n" + std::string(3 << 20, '#'))), "at most 1048576"));
}

TEST(Nrrd, SurvivesEveryTruncation) {
  const TempFolder folder;
  const std::string axes = "space: LPS\nspace directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (1,2,3)\n";
  expect_prefixes_are_safe(folder, "a.nrrd", attached(axes));
  expect_prefixes_are_safe(folder, "b.nrrd", header("encoding: gzip\n" + axes) + "\n" + gzipped(stored(kSamples)));
  folder.put("data.raw", stored(kSamples));
  expect_prefixes_are_safe(folder, "c.nhdr", header(axes + "data file: data.raw"));
}

TEST(Nrrd, SurvivesRandomChanges) {
  const TempFolder folder;
  const std::string axes = "space: LPS\nspace directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (1,2,3)\n";
  const std::string plain = header(axes + "byte skip: -1\n");
  expect_flips_are_safe(folder, "a.nrrd", plain + "\n" + stored(kSamples), plain.size());
  const std::string packed = header(axes + "encoding: gzip\n");
  expect_flips_are_safe(folder, "b.nrrd", packed + "\n" + gzipped(stored(kSamples)), packed.size() + 40);
  for (int n = 0; n < 5; ++n) folder.put(numbered("p", n), std::string(12, 'x'));
  const std::string series = header("data file: p%d 0 4 1\n");
  expect_flips_are_safe(folder, "c.nhdr", series, series.size());
}

}  // namespace
}  // namespace isoweave::testing::volume_nrrd_test
