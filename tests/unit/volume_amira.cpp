#include "header_helpers.hpp"
#include "volume/formats/other/run_lengths.hpp"

namespace isoweave::testing::volume_amira_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

// An array of the type over 3 x 2 x 5 samples, whose label is followed by `codec`.
std::string amira(const std::string& form, const std::string& array, const std::string& data,
                  const std::string& codec = "") {
  return "# AmiraMesh " + form +
         " 2.1\n\n\ndefine Lattice 3 2 5\n\nParameters {\n    Content \"3x2x5 short, uniform coordinates\",\n"
         "    BoundingBox 1 2 -4 -2 10 30,\n    CoordType \"uniform\"\n}\n\nLattice { " +
         array + " } @1" + codec + "\n\n# Data section follows\n@1\n" + data;
}

TEST(Amira, ReadsBothByteOrdersAndText) {
  const TempFolder folder;
  std::string numbers;
  for (const std::int16_t sample : kSamples) numbers += std::to_string(sample) + "\n";
  for (const std::string& content :
       {amira("BINARY-LITTLE-ENDIAN", "short Data", stored(kSamples)),
        amira("BINARY", "short Data", stored(kSamples, true) + "\n"), amira("3D ASCII", "short Data", numbers)}) {
    const auto source = open_volume(folder.put("a.am", content));
    const VolumeInfo& info = source->info();
    EXPECT_EQ(info.format, "amira");
    EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{3, 2, 5}));
    // From the first sample to the last.
    EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.5, 2, 5}));
    EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{1, -4, 10}));
    EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
  }
}

TEST(Amira, ReadsRunLengthsAndZlib) {
  const TempFolder folder;
  // Twenty times 7, then ten bytes as they are, then an array of something else.
  const std::string runs = std::string("\x14\x07\x8a", 3) + "0123456789";
  const std::string expected = std::string(20, '\7') + "0123456789";
  const std::string packed = zlibbed(expected);
  for (const auto& [codec, data] : {std::pair{"HxByteRLE", runs}, {"HxZip", packed}}) {
    const std::string label = "(" + std::string(codec) + "," + std::to_string(data.size()) + ")";
    const std::string content = amira("BINARY-LITTLE-ENDIAN", "byte Labels", data + "\n\n@2\nmore", label);
    EXPECT_EQ(stored(read_file<std::uint8_t>(folder.put("a.am", content))), expected) << codec;
    EXPECT_EQ(stored(read_file<std::uint8_t>(folder.put("a.am.gz", gzipped(content)))), expected) << codec;
  }
}

TEST(Amira, AppliesTheUnitOfNewerFiles) {
  const TempFolder folder;
  const auto info = [&](const std::string& unit) {
    std::string content = amira("BINARY-LITTLE-ENDIAN", "short Data", stored(kSamples));
    content.insert(content.find("    Content"), "    Units {\n        Coordinates \"" + unit + "\"\n    }\n");
    content.replace(content.find("define Lattice"), 14, "define  Lattice");
    return open_volume(folder.put("a.am", content))->info();
  };
  EXPECT_EQ(info("\xc2\xb5m").geometry.unit, "um");
  EXPECT_EQ(info("cm").geometry.unit, "mm");
  EXPECT_EQ(info("cm").geometry.spacing, (std::array<double, 3>{5, 20, 50}));
  EXPECT_EQ(info("cm").geometry.origin, (std::array<double, 3>{10, -40, 100}));
  EXPECT_EQ(info("foo").geometry.unit, "");
  EXPECT_TRUE(contains(info("foo").notes.at(0), "'foo' is no known length"));
}

TEST(Amira, SaysWhatItDoesNotRead) {
  const TempFolder folder;
  const std::string bytes = stored(kSamples);
  const std::string little = "BINARY-LITTLE-ENDIAN";
  const auto refused = [&](const std::string& content, const std::string& why) {
    const std::string message = refusal(folder.put("a.am", content));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string content = amira(little, "short Data", bytes);
    const std::size_t at = content.find(from);
    return content.replace(at, from.size(), to);
  };
  refused(amira(little, "float[3] Data", bytes), "per sample, found 'float[3]'");
  refused(amira(little, "short Data", bytes, "(HxOther,5)"), "'HxOther'");
  refused(amira(little, "short Data", bytes, "(HxByteRLE)"), "packed in");
  refused(amira(little, "short Data", bytes, "(HxByteRLE,61)"), "61 bytes of samples");
  refused(amira(little, "short Data", bytes, "(HxByteRLE,-1)"), "'-1'");
  refused(amira("BINARY-MIDDLE", "short Data", bytes), "'BINARY-MIDDLE'");
  refused(amira(little, "short Data", bytes.substr(1)), "60 bytes of samples");
  refused(with("3 2 5", "3 2 x"), "'3 2 x'");
  refused(with("3 2 5", "3 2 0"), "at least 1");
  refused(with("3 2 5", "2000000000 2000000000 2000000000"), "2^63");
  refused(with("\"uniform\"", "\"curvilinear\""), "curvilinear");
  refused(with("1 2 -4 -2 10 30", "1 2 -4"), "6 numbers");
  refused(with("1 2 -4", "1 1 -4"), "spacing on axis 0");
  refused(with("Lattice {", "Nodes {"), "an array over a lattice as the first one, found none");
  refused(with("\n@1\n", "\n@2\n"), "found '@2'");
  refused(with("\n@1\n", "\n"), "samples behind '@1'");
  EXPECT_TRUE(contains(open_volume(folder.put("a.am", with("BoundingBox", "Box")))->info().notes.at(0), "spacing"));
}

TEST(Amira, SurvivesTruncationAndRandomChanges) {
  const TempFolder folder;
  const std::string content = amira("BINARY-LITTLE-ENDIAN", "short Data", stored(kSamples));
  expect_prefixes_are_safe(folder, "a.am", content);
  expect_flips_are_safe(folder, "a.am", content, 260, 1000);
  const std::string runs = amira("BINARY", "byte Data", std::string("\x1e\x07", 2), "(HxByteRLE,2)");
  expect_prefixes_are_safe(folder, "a.am", runs);
  expect_flips_are_safe(folder, "a.am", runs, 290, 1000);
}

}  // namespace
}  // namespace isoweave::testing::volume_amira_test
