#include <cmath>

#include "volume_helpers.hpp"

namespace isoweave::testing {
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
      {"float", SampleType::kFloat32},       {"double", SampleType::kFloat64}};
  for (const auto& [name, type] : types) {
    const std::string content = header("type: " + name + "\n") + "\n" + std::string(30 * sample_bytes(type), 'x');
    EXPECT_EQ(open_volume(folder.put("a.nrrd", content))->info().type, type) << name;
  }
  for (const std::string name : {"int64", "unsigned long long", "block", "half", ""}) {
    EXPECT_TRUE(contains(refusal_of(folder, "type: " + name + "\n"), "type '" + name + "'")) << name;
  }
}

TEST(Nrrd, RefusesEncodingsItDoesNotKnow) {
  const TempFolder folder;
  for (const std::string name : {"bzip2", "ascii", "hex", "zrl"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "encoding: " + name + "\n"), "encoding '" + name + "' is not supported"));
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
  EXPECT_TRUE(contains(refusal(folder.put("a.nhdr", header("data file: gone.raw\n"))), "gone.raw: cannot be opened"));
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
    EXPECT_TRUE(contains(message, "expected") || contains(message, "cannot be opened")) << file << ": " << message;
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
  for (const std::string wrong : {"(1,0,0) (2,0,0) (0,0,1)", "(0,0,0) (0,1,0) (0,0,1)", "(1,0,0) (0,nan,0) (0,0,1)",
                                  "(1,0,0) (0,inf,0) (0,0,1)", "(1,0,0) (0,1,0)", "(1,0,0) (0,1,0) (0,0,1",
                                  "(1,0,0,0) (0,1,0,0) (0,0,1,0)", "1 0 0", "(1,0,0) none (0,0,1)"}) {
    EXPECT_TRUE(contains(refusal_of(folder, "space: LPS\nspace directions: " + wrong + "\n"), "expected")) << wrong;
  }
  const std::string axes = "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
  EXPECT_TRUE(contains(refusal_of(folder, axes + "space origin: (0,nan,0)\n"), "origin"));
}

TEST(Nrrd, TakesUnitsThatAllAxesShare) {
  const TempFolder folder;
  EXPECT_EQ(info_of(folder, "units: \"mm\" \"mm\" \"mm\"\n").geometry.unit, "mm");
  EXPECT_EQ(info_of(folder, "space units: \"microns\" \"microns\" \"microns\"\n").geometry.unit, "um");
  for (const std::string units : {"\"mm\" \"mm\" \"m\"", "\"inch\" \"inch\" \"inch\""}) {
    const VolumeInfo info = info_of(folder, "space units: " + units + "\n");
    EXPECT_EQ(info.geometry.unit, "");
    EXPECT_TRUE(contains(info.notes.back(), "unit")) << units;
  }
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
  EXPECT_TRUE(contains(refusal_of(folder, "dimension: 4\nsizes: 3 2 2 2\n"), "expected 3 dimensions, found 4"));
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
}  // namespace isoweave::testing
