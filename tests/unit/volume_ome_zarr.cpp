// What a folder of Zarr or N5 holds, which part of it is read, and where its samples lie.
#include "zarr_helpers.hpp"

namespace isoweave::testing::volume_ome_zarr_test {
namespace {

using namespace zarr_files;

void expect_places(const Geometry& geometry, const std::array<double, 3>& spacing,
                   const std::array<double, 3>& origin) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(geometry.spacing.at(axis), spacing.at(axis), 1e-12) << axis;
    EXPECT_NEAR(geometry.origin.at(axis), origin.at(axis), 1e-12) << axis;
  }
}

TEST(OmeZarr, TransformationsOfLevelAndImageAreApplied) {
  const TempFolder folder;
  const ArrayJson whole = {scale({10, 10, 10}), shift({100, 200, 300})};
  put_group(folder / "a", image(kAxes,
                                {level("0", list({scale({2, 0.5, 0.25})})),
                                 level("1", {scale({4, 1, 0.5}), shift({1, 0.25, 0.125})})},
                                whole));
  put_array(folder / "a/0", {4, 4, 6});
  put_array(folder / "a/1", {2, 2, 3});
  const VolumeInfo full = open_volume(folder / "a")->info();
  expect_places(full.geometry, {2.5, 5, 20}, {300, 200, 100});
  EXPECT_EQ(full.geometry.unit, "um");
  EXPECT_EQ(full.part, "level 0");
  OpenOptions options;
  options.level = 1;
  const VolumeInfo small = open_volume(folder / "a", options)->info();
  expect_places(small.geometry, {5, 10, 40}, {301.25, 202.5, 110});
  EXPECT_EQ(small.dims, (std::array<std::int64_t, 3>{3, 2, 2}));
  EXPECT_EQ(small.part, "level 1");
  EXPECT_EQ(small.header, folder / "a/1/.zarray");
  options.level = 2;
  EXPECT_TRUE(contains(refusal(folder / "a", options), "expected --level below 2, found 2"));
}

TEST(OmeZarr, ChannelAndTimeAreChosen) {
  const TempFolder folder;
  ArrayJson axes = {{{"name", "t"}, {"type", "time"}}, {{"name", "c"}, {"type", "channel"}}};
  axes.insert(axes.end(), kAxes.begin(), kAxes.end());
  put_group(folder / "a", image(axes, list({level("0", list({scale({1, 1, 1, 1, 1})}))})));
  put_array(folder / "a/0", {2, 3, 2, 2, 2});
  const auto first = open_volume(folder / "a");
  EXPECT_EQ(samples_of<std::int16_t>(*first), (std::vector<std::int16_t>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(first->info().notes.size(), 2U);
  OpenOptions options;
  options.channel = 2;
  options.time = 1;
  const auto chosen = open_volume(folder / "a", options);
  EXPECT_EQ(samples_of<std::int16_t>(*chosen), (std::vector<std::int16_t>{41, 42, 43, 44, 45, 46, 47, 48}));
  EXPECT_EQ(chosen->info().part, "time 1, channel 2");
  EXPECT_TRUE(chosen->info().notes.empty());
  options.channel = 3;
  EXPECT_TRUE(contains(refusal(folder / "a", options), "expected --channel below 3, found 3"));
}

TEST(OmeZarr, SlicesThatWereWrittenAsChannelsAreAsFarApartAsSlices) {
  const TempFolder folder;
  ArrayJson axes = {{{"name", "c"}, {"type", "channel"}}};
  axes.insert(axes.end(), kAxes.begin(), kAxes.end());
  put_group(folder / "a", image(axes, list({level("0", list({scale({1, 4, 2, 3})}))})));
  put_array(folder / "a/0", {3, 1, 2, 2});
  OpenOptions options;
  options.slices_from = SliceAxis::kChannels;
  const auto source = open_volume(folder / "a", options);
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{2, 2, 3}));
  expect_places(source->info().geometry, {3, 2, 4}, {0, 0, 0});
  EXPECT_EQ(samples_of<std::int16_t>(*source).at(11), 12);
  EXPECT_TRUE(contains(open_volume(folder / "a")->info().notes.at(0), "--slices-from channel takes them for slices"));
}

TEST(OmeZarr, AxesAreFoundByTheirNames) {
  const TempFolder folder;
  put_group(folder / "a",
            image({{{"name", "x"}}, {{"name", "z"}}, {{"name", "y"}}}, list({level("0", list({scale({1, 3, 2})}))})));
  put_array(folder / "a/0", {2, 3, 4});
  const auto source = open_volume(folder / "a");
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{2, 4, 3}));
  expect_places(source->info().geometry, {1, 2, 3}, {0, 0, 0});
  // (x, z, y) = (1, 0, 0) is the 13th sample stored, (0, 0, 1) the second.
  const auto samples = samples_of<std::int16_t>(*source, 1);
  EXPECT_EQ(samples[1], 13);
  EXPECT_EQ(samples[2], 2);
  EXPECT_EQ(samples[8], 5);
}

TEST(OmeZarr, UnitsThatDifferBecomeThoseOfX) {
  const TempFolder folder;
  ArrayJson axes = kAxes;
  axes[0]["unit"] = "millimeter";
  put_group(folder / "a", image(axes, list({level("0", list({scale({0.002, 0.5, 0.5})}))})));
  put_array(folder / "a/0", {2, 2, 2});
  expect_places(open_volume(folder / "a")->info().geometry, {0.5, 0.5, 2}, {0, 0, 0});
}

TEST(OmeZarr, VersionFiveIsInZarr3) {
  const TempFolder folder;
  ArrayJson attributes = {{"ome", image(kAxes, list({level("0", list({scale({3, 2, 1})}))}))}};
  put_json(folder / "a/zarr.json", {{"zarr_format", 3}, {"node_type", "group"}, {"attributes", attributes}});
  put_json(folder / "a/0/zarr.json",
           {{"zarr_format", 3},
            {"node_type", "array"},
            {"shape", {1, 1, 2}},
            {"data_type", "uint8"},
            {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", {1, 1, 2}}}}}},
            {"chunk_key_encoding", {{"name", "v2"}}},
            {"fill_value", 0},
            {"codecs", {{{"name", "bytes"}}}}});
  put_file(folder / "a/0/0.0.0", "\x07\x09");
  EXPECT_EQ(read_file<std::uint8_t>(folder / "a"), (std::vector<std::uint8_t>{7, 9}));
  expect_places(open_volume(folder / "a")->info().geometry, {1, 2, 3}, {0, 0, 0});
}

TEST(OmeZarr, ALevelThatIsOpenedByItselfLiesWhereItsImageSays) {
  const TempFolder folder;
  ArrayJson axes = kAxes;
  axes[0]["unit"] = "millimeter";
  const ArrayJson levels = {level("deep/s0", list({scale({0.002, 0.5, 0.5})})),
                            level("./deep/s1/", list({scale({0.004, 1, 1}), shift({0.001, 0.25, 0.5})}))};
  put_group(folder / "a", image(axes, levels));
  put_group(folder / "a/deep", ArrayJson::object());
  put_array(folder / "a/deep/s0", {2, 2, 2});
  put_array(folder / "a/deep/s1", {2, 2, 2});
  put_array(folder / "a/deep/other", {2, 2, 2});
  OpenOptions options;
  options.level = 1;
  const Geometry half = open_volume(folder / "a", options)->info().geometry;
  for (const std::string path : {"a/deep/s1", "a/deep/s1/", "a/deep/./s1", "a/../a/deep/s1"}) {
    const VolumeInfo info = open_volume(folder / path)->info();
    expect_places(info.geometry, {1, 1, 4}, {0.5, 0.25, 1});
    EXPECT_EQ(info.geometry.spacing, half.spacing) << path;
    EXPECT_EQ(info.geometry.unit, half.unit);
    EXPECT_TRUE(contains(info.notes.back(), "level '1' of the image in a folder above it")) << path;
  }
  options = {};
  options.dataset = "deep/s0";
  expect_places(open_volume(folder / "a", options)->info().geometry, {0.5, 0.5, 2}, {0, 0, 0});
  EXPECT_TRUE(contains(open_volume(folder / "a/deep/other")->info().notes.at(0), "axis 0 is not given"));
}

TEST(OmeZarr, WrongDescriptionsAreRefused) {
  const TempFolder folder;
  put_array(folder / "a/0", {2, 2, 2});
  const auto refused = [&folder](const ArrayJson& attributes) {
    put_group(folder / "a", attributes);
    return refusal(folder / "a");
  };
  EXPECT_TRUE(
      contains(refused({{"multiscales", ArrayJson::array()}}), "expected an image in 'multiscales', found none"));
  EXPECT_TRUE(contains(refused(image(kAxes, ArrayJson::array())), "expected datasets in 'multiscales'"));
  EXPECT_TRUE(contains(refused(image(kAxes, list({level("7", nullptr)}))), "expected an array or group at '7'"));
  EXPECT_TRUE(contains(refused(image(kAxes, list({level("../b", nullptr)}))), "expected a path inside the folder"));
  EXPECT_TRUE(contains(refused(image(kAxes, list({level("/etc", nullptr)}))), "expected a path inside the folder"));
  EXPECT_TRUE(contains(refused(image(kAxes, list({level("0", list({scale({1, 2})}))}))),
                       "its transformations, found one of 3"));
  EXPECT_TRUE(
      contains(refused(image({"z", "y"}, list({level("0", nullptr)}))), "the 2 axes of its image, found one of 3"));
  EXPECT_TRUE(
      contains(refused(image(kAxes, list({level("0", list({scale({1, 0, 2})}))}))), "sample spacing on axis 1"));
  const ArrayJson turned = {{"type", "affine"}, {"affine", {1}}};
  EXPECT_TRUE(contains(refused(image(kAxes, list({level("0", list({turned}))}))), "found 'affine'"));
}

TEST(ZarrFolder, AnArrayIsChosenByItsPath) {
  const TempFolder folder;
  put_group(folder / "a", ArrayJson::object());
  put_array(folder / "a/raw", {2, 2, 2});
  put_array(folder / "a/table", {7});
  const VolumeInfo only = open_volume(folder / "a")->info();
  EXPECT_EQ(only.dims[0], 2);
  EXPECT_TRUE(contains(only.notes.back(), "'raw' is the only array"));
  put_array(folder / "a/deep/er", {2, 2, 3});
  EXPECT_TRUE(contains(refusal(folder / "a"), "expected --dataset with one of 'raw', 'deep/er', found no choice"));
  OpenOptions options;
  options.dataset = "deep/er";
  EXPECT_EQ(open_volume(folder / "a", options)->info().dims[0], 3);
  EXPECT_EQ(open_volume(folder / "a", options)->info().part, "dataset deep/er");
  options.dataset = "nothing";
  EXPECT_TRUE(contains(refusal(folder / "a", options), "expected an array or group at 'nothing'"));
  EXPECT_TRUE(contains(
      refusal(folder.put("x.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\n1"), options),
      "expected HDF5, Zarr, N5, VTI, VTR, legacy VTK or NPZ for --dataset, found nrrd"));
}

TEST(ZarrFolder, AttributesOfPlainArraysSayWhereSamplesLie) {
  const TempFolder folder;
  put_array(folder / "a", {2, 2, 2},
            {{"resolution", {40, 4, 8}}, {"offset", {400, 0, 80}}, {"units", {"nm", "nm", "nm"}}});
  const Geometry geometry = open_volume(folder / "a")->info().geometry;
  expect_places(geometry, {8, 4, 40}, {80, 0, 400});
  EXPECT_EQ(geometry.unit, "nm");
  put_array(folder / "c", {2, 2, 2}, {{"element_size_um", {40, 4, 8}}, {"offset", {400, 0, 80}}});
  expect_places(open_volume(folder / "c")->info().geometry, {8, 4, 40}, {80, 0, 400});
  put_array(folder / "d", {2, 2, 2}, {{"offset", {400, 0, 80}}});
  const VolumeInfo unspaced = open_volume(folder / "d")->info();
  expect_places(unspaced.geometry, {1, 1, 1}, {0, 0, 0});
  EXPECT_TRUE(contains(unspaced.notes.at(0), "offset has no spacing beside it"));
  put_array(folder / "b", {2, 2, 3, 2}, {{"_ARRAY_DIMENSIONS", {"channel", "z", "y", "x"}}});
  EXPECT_EQ(open_volume(folder / "b")->info().dims, (std::array<std::int64_t, 3>{2, 3, 2}));
}

// Coordinates of one axis, as xarray keeps them.
void put_coordinates(const std::string& folder, const std::vector<std::int16_t>& values, const std::string& unit) {
  const auto count = static_cast<std::int64_t>(values.size());
  put_array(folder, {count}, {{"_ARRAY_DIMENSIONS", list({folder.substr(folder.rfind('/') + 1)})}, {"units", unit}});
  std::string samples;
  for (const std::int16_t value : values) samples += bytes_of(value);
  put_file(folder + "/0", samples);
}

TEST(ZarrFolder, CoordinatesOfXarraySayWhereSamplesLie) {
  const TempFolder folder;
  put_group(folder / "a", ArrayJson::object());
  put_array(folder / "a/v", {4, 2, 3}, {{"_ARRAY_DIMENSIONS", {"x", "z", "y"}}});
  put_coordinates(folder / "a/x", {100, 102, 104, 106}, "um");
  put_coordinates(folder / "a/y", {9, 6, 3}, "um");
  put_coordinates(folder / "a/z", {0, 1}, "degrees");
  OpenOptions options;
  options.dataset = "v";
  for (const VolumeInfo& info : {open_volume(folder / "a")->info(), open_volume(folder / "a", options)->info(),
                                 open_volume(folder / "a/v")->info()}) {
    expect_places(info.geometry, {2, 3, 1}, {100, 9, 0});
    EXPECT_EQ(info.geometry.direction, (std::array<double, 9>{1, 0, 0, 0, -1, 0, 0, 0, 1}));
    EXPECT_EQ(info.geometry.unit, "um");
    EXPECT_TRUE(has_note(info, "the coordinates 'z' of axis 2 are in 'degrees', which is no length that is known"));
  }
  // Arrays beside the folder that was named are none of a stranger's business.
  options = {};
  options.external = false;
  expect_places(open_volume(folder / "a/v", options)->info().geometry, {1, 1, 1}, {0, 0, 0});
  expect_places(open_volume(folder / "a", options)->info().geometry, {2, 3, 1}, {100, 9, 0});
  put_array(folder / "a/v", {4, 2, 3}, {{"_ARRAY_DIMENSIONS", {"x", "z", "y"}}, {"element_size_um", {1, 3, 2}}});
  expect_places(open_volume(folder / "a")->info().geometry, {1, 2, 3}, {0, 0, 0});
  put_array(folder / "a/v", {4, 2, 3}, {{"_ARRAY_DIMENSIONS", {"x", "../x", "y"}}});
  EXPECT_TRUE(has_note(open_volume(folder / "a")->info(), "axis '../x' is taken for z"));
  put_json(folder / "a/x/.zarray", {{"zarr_format", 2}, {"shape", {4}}, {"dtype", "<U5"}});
  EXPECT_TRUE(has_note(open_volume(folder / "a")->info(), "the coordinates 'x' of axis 0 are no numbers"));
}

TEST(ZarrFolder, CoordinatesByNamesOfDimensionsInZarr3) {
  const TempFolder folder;
  put_json(folder / "a/zarr.json", {{"zarr_format", 3}, {"node_type", "group"}});
  put_zarr3(folder / "a/v", {{"dimension_names", {"z", nullptr, "x"}},
                             {"attributes", {{"scale_factor", 0.5}, {"_FillValue", "AAAAAAAA+H8="}}}});
  ArrayJson axis = kZarr3;
  axis.update({{"shape", {3}}, {"dimension_names", list({"z"})}, {"attributes", {{"units", "nm"}, {"add_offset", 7}}}});
  axis["chunk_grid"]["configuration"]["chunk_shape"] = list({2});
  put_json(folder / "a/z/zarr.json", axis);
  put_file(folder / "a/z/c/0", bytes_of(std::int16_t{10}) + bytes_of(std::int16_t{14}));
  put_file(folder / "a/z/c/1", bytes_of(std::int16_t{18}) + bytes_of(std::int16_t{0}));
  const VolumeInfo info = open_volume(folder / "a")->info();
  expect_places(info.geometry, {1, 1, 4}, {0, 0, 17});
  EXPECT_EQ(info.slope, 0.5);
  EXPECT_FALSE(has_note(info, "_FillValue"));
}

TEST(ZarrFolder, SamplesArePackedByAFactorAndAnOffset) {
  const TempFolder folder;
  put_array(folder / "a", {2, 2, 2},
            {{"_ARRAY_DIMENSIONS", {"z", "y", "x"}}, {"scale_factor", 0.5}, {"add_offset", 100}});
  ArrayJson metadata = kZarr2;
  metadata.update({{"shape", {2, 2, 2}}, {"chunks", {2, 2, 2}}, {"fill_value", -32768}});
  put_json(folder / "a/.zarray", metadata);
  const VolumeInfo info = open_volume(folder / "a")->info();
  EXPECT_EQ(info.slope, 0.5);
  EXPECT_EQ(info.intercept, 100);
  EXPECT_TRUE(has_note(info, "attribute _FillValue (-32768) is not applied"));
  put_array(folder / "b", {2, 2, 2}, {{"scale_factor", "0.5"}, {"missing_value", {"x", 1}}});
  const VolumeInfo plain = open_volume(folder / "b")->info();
  EXPECT_EQ(plain.slope, 1);
  EXPECT_TRUE(has_note(plain, "attribute scale_factor is no finite number and is left out"));
  EXPECT_TRUE(has_note(plain, "attribute missing_value ('x', '') is not applied"));
  put_n5(folder / "n5", "raw", {{"scale_factor", 2}});
  EXPECT_EQ(open_volume(folder / "n5")->info().slope, 2);
}

TEST(ZarrFolder, AxesWithoutNames) {
  const TempFolder folder;
  put_array(folder / "flat", {3, 4});
  EXPECT_EQ(open_volume(folder / "flat")->info().dims, (std::array<std::int64_t, 3>{4, 3, 1}));
  put_array(folder / "ones", {1, 2, 3, 4, 1});
  EXPECT_EQ(open_volume(folder / "ones")->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  put_array(folder / "four", {2, 2, 3, 4});
  EXPECT_TRUE(contains(refusal(folder / "four"), "found one of 2 x 2 x 3 x 4"));
  OpenOptions options;
  options.channel = 1;
  EXPECT_EQ(read_file<std::int16_t>(folder / "four", options)[0], 25);
  put_array(folder / "line", {4});
  EXPECT_TRUE(contains(refusal(folder / "line"), "expected an array of 2 or 3 axes"));
  put_array(folder / "named", {2, 2, 2, 2}, {{"_ARRAY_DIMENSIONS", {"angle", "z", "y", "x"}}});
  EXPECT_TRUE(contains(refusal(folder / "named"), "2 ('angle')"));
}

}  // namespace
}  // namespace isoweave::testing::volume_ome_zarr_test
