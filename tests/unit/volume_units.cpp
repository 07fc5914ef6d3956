// Units of length in every spelling, and axes whose units differ.
#include "files/length_units.hpp"
#include "isoweave/pipeline.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing::volume_units_test {
namespace {

std::string found(const std::string& text) {
  const std::optional<LengthUnit> unit = find_length_unit(text);
  if (!unit) return "none";
  std::ostringstream words;
  words << unit->scale << " " << unit->name;
  return words.str();
}

TEST(LengthUnits, EverySpelling) {
  for (const std::string text :
       {"um", "UM", " um ", "micron", "microns", "Micron", "micrometer", "micrometre", "micrometers", "Micrometres",
        "\xc2\xb5m", "\xce\xbcm", "\\u00B5m", "\\u00b5m", "\\u03BCm", "\xb5m", "&micro;m", "\xc2\xb5m\r"}) {
    EXPECT_EQ(found(text), "1 um") << text;
  }
  for (const std::string text : {"mm", "MM", "\tmm", "millimeter", "millimetre", "millimeters", "Millimetres"}) {
    EXPECT_EQ(found(text), "1 mm") << text;
  }
  for (const std::string text : {"nm", "nanometer", "nanometre", "nanometers"}) EXPECT_EQ(found(text), "1 nm") << text;
  for (const std::string text : {"m", "meter", "metres", "METER"}) EXPECT_EQ(found(text), "1 m") << text;
  for (const std::string text : {"cm", "centimeter", "centimetres"}) EXPECT_EQ(found(text), "10 mm") << text;
  for (const std::string text : {"inch", "inches", "in", "Inch"}) EXPECT_EQ(found(text), "1 in") << text;
  for (const std::string text : {"ft", "foot", "feet"}) EXPECT_EQ(found(text), "12 in") << text;
  for (const std::string text :
       {"angstrom", "Angstroms", "\xc3\x85", "\xc3\xa5", "\xe2\x84\xab", "\\u00C5", "\xc5", "\xc3\x85ngstr\xc3\xb6m"}) {
    EXPECT_EQ(found(text), "0.1 nm") << text;
  }
  EXPECT_EQ(found("pm"), "0.001 nm");
  EXPECT_EQ(found("km"), "1000 m");
  // OME's megametre is no millimetre; the others are no lengths.
  for (const std::string text : {"Mm", "pixel", "pixels", "s", "", " ", "furlong", "ms", "nms", "reference frame"}) {
    EXPECT_EQ(found(text), "none") << text;
  }
}

CommonUnit common(const std::string& x, const std::string& y, const std::string& z) { return common_unit({x, y, z}); }

TEST(LengthUnits, AxesAreInTheUnitOfTheFirst) {
  const CommonUnit unit = common("nm", "\\u00B5m", "mm");
  EXPECT_EQ(unit.unit, "nm");
  EXPECT_EQ(unit.scale, (std::array<double, 3>{1, 1000, 1000000}));
  EXPECT_EQ(unit.notes.size(), 2U);
  EXPECT_EQ(common("mm", "mm", "nm").scale[2], 1e-6);
  EXPECT_EQ(common("cm", "mm", "inch").unit, "mm");
  EXPECT_EQ(common("cm", "mm", "inch").scale, (std::array<double, 3>{10, 1, 25.4}));
  EXPECT_TRUE(common("um", "micron", "Micrometers").notes.empty());
  EXPECT_TRUE(common("pixel", "pixel", "pixel").notes.empty());
  EXPECT_TRUE(contains(common("furlong", "furlong", "furlong").notes.at(0), "'furlong'"));
}

TEST(LengthUnits, WhatIsNotSaidIsTakenAsTheOthers) {
  const CommonUnit unit = common("um", "um", "");
  EXPECT_EQ(unit.scale[2], 1);
  EXPECT_EQ(unit.notes.at(0), "the unit of axis 2 is not given and taken as 'um'");
  EXPECT_EQ(common("", "", "um").unit, "um");
  const CommonUnit absent = common_unit({std::nullopt, std::nullopt, "cm"});
  EXPECT_EQ(absent.unit, "mm");
  EXPECT_EQ(absent.scale, (std::array<double, 3>{1, 1, 10}));
}

TEST(LengthUnits, AnUnknownUnitBesideAKnownOneIsAConflict) {
  EXPECT_EQ(common("um", "um", "pixel").conflict, "'um', 'um', 'pixel'");
  EXPECT_EQ(common("um", "um", "pixel").unit, "um");
  EXPECT_FALSE(common("pixel", "um", "um").conflict.empty());
  EXPECT_EQ(common("pixel", "um", "um").unit, "");
  EXPECT_FALSE(common("furlong", "furlong", "chain").conflict.empty());
  EXPECT_TRUE(common("pixel", "pixel", "").conflict.empty());
}

TEST(LengthUnits, RatiosAreRoundedOnce) {
  EXPECT_EQ(unit_in("in", "mm"), 25.4);
  EXPECT_EQ(unit_in("mm", "in"), 1 / 25.4);
  EXPECT_EQ(unit_in("um", "m"), 1e-6);
  EXPECT_EQ(unit_in("m", "nm"), 1e9);
  EXPECT_FALSE(unit_in("", "mm"));
  EXPECT_FALSE(unit_in("mm", "furlong"));
}

TEST(ParseLength, ConvertsToTheUnitOfTheInput) {
  const auto parsed = [](const char* text, const char* unit) {
    const Length length = parse_length(text, unit);
    EXPECT_FALSE(length.in_voxels);
    return length.value;
  };
  EXPECT_EQ(parsed("0.05", "um"), 0.05);
  EXPECT_EQ(parsed("500nm", "um"), 0.5);
  EXPECT_EQ(parsed("500 nm", ""), 0.0005);
  EXPECT_EQ(parsed("2\u00b5m", "nm"), 2000);
  EXPECT_EQ(parsed("1cm", "mm"), 10);
  EXPECT_EQ(parsed("1in", "mm"), 25.4);
  EXPECT_EQ(parsed("2ft", "in"), 24);
  EXPECT_EQ(parsed("25.4mm", "in"), 1);
  EXPECT_TRUE(parse_length("0.2vox", "").in_voxels);
  for (const char* text : {"", "mm", "-1mm", "1 furlong", "inf", "1px", "1e999"}) {
    EXPECT_THROW(parse_length(text, "mm"), std::invalid_argument) << text;
  }
  EXPECT_THROW(parse_length("1mm", "furlong"), std::invalid_argument);
}

TEST(ParseLength, PercentIsOfTheDiagonal) {
  EXPECT_EQ(parse_length("5%", "um", 200).value, 10);
  EXPECT_FALSE(parse_length("5%", "um", 200).in_voxels);
  EXPECT_EQ(parse_length("0.5um", "um", 200).value, 0.5);
  EXPECT_THROW(parse_length("5%", "um"), std::invalid_argument);
  EXPECT_THROW(parse_length("5%%", "um", 200), std::invalid_argument);
  EXPECT_THROW(parse_length("-5%", "um", 200), std::invalid_argument);
}

TEST(BoxDiagonal, OfVolumesAndMeshes) {
  VolumeInfo volume;
  volume.dims = {3, 4, 12};
  volume.geometry.spacing = {2, 2, 2};
  EXPECT_EQ(box_diagonal(volume), 26);
  TriangleMesh mesh;
  EXPECT_EQ(box_diagonal(mesh), 0);
  mesh.vertices = {{-1, 0, 0}, {2, 4, -6}, {0, 1, 6}};
  EXPECT_EQ(box_diagonal(mesh), 13);
}

}  // namespace
}  // namespace isoweave::testing::volume_units_test
