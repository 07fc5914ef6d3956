// Where samples lie by Imaris, ITK, MINC and DREAM.3D, which stand on HDF5.
#include <cmath>

#include "hdf5_helpers.hpp"

namespace isoweave::testing::volume_hdf5_places_test {
namespace {

using Triple = std::array<double, 3>;

// Two levels, times and channels; samples of 1 x 2 x 3 in a dataset padded to 2 x 4 x 4.
void put_imaris(Writer& writer) {
  writer.put_group("/DataSetInfo/Image");
  const std::string image = "/DataSetInfo/Image";
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{{"X", "3"},
                                                                                    {"Y", "2"},
                                                                                    {"Z", "1"},
                                                                                    {"ExtMin0", "10"},
                                                                                    {"ExtMax0", "11.5"},
                                                                                    {"ExtMin1", "-1"},
                                                                                    {"ExtMax1", "1"},
                                                                                    {"ExtMin2", "0"},
                                                                                    {"ExtMax2", "4.0"},
                                                                                    {"Unit", "um"}}) {
    writer.put_letters(image, name, value);
  }
  for (const std::string level : {"0", "1"}) {
    for (const std::string time : {"0", "1"}) {
      for (const std::string channel : {"0", "1", "2"}) {
        const std::string group = "/DataSet/ResolutionLevel " + level + "/TimePoint " + time + "/Channel " + channel;
        const std::int16_t base = static_cast<std::int16_t>(std::stoi(level + time + channel));
        writer.put_int16(group + "/Data", {2, 4, 4}, chunks({2, 4, 4}));
        writer.put_samples(group + "/Data", {2, 4, 4}, base);
        writer.put_letters(group, "ImageSizeX", level == "0" ? "3" : "2");
        writer.put_letters(group, "ImageSizeY", level == "0" ? "2" : "1");
        writer.put_letters(group, "ImageSizeZ", "1");
      }
    }
  }
}

TEST(Hdf5Places, ImarisExtentsSizesAndChoices) {
  const TempFolder folder;
  const std::string path = folder / "a.ims";
  {
    Writer writer(path);
    put_imaris(writer);
  }
  const auto first = open_volume(path);
  EXPECT_EQ(first->info().dims, (std::array<std::int64_t, 3>{3, 2, 1}));
  EXPECT_EQ(first->info().geometry.spacing, (Triple{0.5, 1, 4}));
  EXPECT_EQ(first->info().geometry.origin, (Triple{10.25, -0.5, 2}));
  EXPECT_EQ(first->info().geometry.unit, "um");
  EXPECT_EQ(first->info().part,
            "dataset /DataSet/ResolutionLevel 0/TimePoint 0/Channel 0/Data, level 0, time 0, channel 0");
  EXPECT_EQ(first->info().notes.size(), 3U);
  EXPECT_EQ(samples_of<std::int16_t>(*first), (std::vector<std::int16_t>{0, 100, 200, 400, 500, 600}));
  OpenOptions options;
  options.level = 1;
  options.time = 1;
  options.channel = 2;
  const auto chosen = open_volume(path, options);
  EXPECT_EQ(chosen->info().dims, (std::array<std::int64_t, 3>{2, 1, 1}));
  EXPECT_EQ(chosen->info().geometry.spacing, (Triple{0.75, 2, 4}));
  EXPECT_EQ(chosen->info().geometry.origin, (Triple{10.375, 0, 2}));
  EXPECT_EQ(samples_of<std::int16_t>(*chosen), (std::vector<std::int16_t>{112, 212}));
  options.channel = 3;
  EXPECT_TRUE(contains(refusal(path, options), "expected --channel below 3, found 3"));
  options = {};
  options.level = 2;
  EXPECT_TRUE(contains(refusal(path, options), "expected --level below 2, found 2"));
  options = {};
  options.dataset = "DataSet/ResolutionLevel 1/TimePoint 0/Channel 1/Data";
  EXPECT_EQ(open_volume(path, options)->info().geometry.spacing, (Triple{0.75, 2, 4}));
}

TEST(Hdf5Places, ImarisSizesBeyondTheDatasetAreRefused) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.ims");
    writer.put_group("/DataSetInfo/Image");
    for (const std::string name : {"X", "Y", "Z"}) writer.put_letters("/DataSetInfo/Image", name, "5");
    writer.put_int16("/DataSet/ResolutionLevel 0/TimePoint 0/Channel 0/Data", {5, 5, 4});
  }
  EXPECT_TRUE(contains(refusal(folder / "a.ims"), "expected 5 samples along x, found 4"));
}

TEST(Hdf5Places, ItkDirectionsAreRows) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.h5");
    writer.put_int16("/ITKImage/0/VoxelData", {2, 3, 4});
    writer.put_values("/ITKImage/0/Spacing", {3}, {2, 3, 4});
    writer.put_values("/ITKImage/0/Origin", {3}, {10, 20, 30});
    writer.put_values("/ITKImage/0/Directions", {3, 3}, {0, 1, 0, -1, 0, 0, 0, 0, 1});
  }
  const auto source = open_volume(folder / "a.h5");
  const Geometry& geometry = source->info().geometry;
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(geometry.spacing, (Triple{2, 3, 4}));
  EXPECT_EQ(geometry.origin, (Triple{10, 20, 30}));
  EXPECT_EQ(geometry.direction, (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(geometry.space, Space::kLps);
  EXPECT_EQ(samples_of<std::int16_t>(*source), counting(24));
  {
    Writer writer(folder / "b.h5");
    writer.put_int16("/ITKImage/0/VoxelData", {2, 3, 4, 2});
    writer.put_values("/ITKImage/0/Spacing", {3}, {2, 3, 4});
    writer.put_values("/ITKImage/0/Origin", {3}, {10, 20, 30});
    writer.put_values("/ITKImage/0/Directions", {3, 3}, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  }
  OpenOptions options;
  options.channel = 1;
  EXPECT_EQ(read_file<std::int16_t>(folder / "b.h5", options).at(3), 8);
  {
    Writer writer(folder / "c.h5");
    writer.put_int16("/ITKImage/0/VoxelData", {2, 3, 4});
    writer.put_values("/ITKImage/0/Spacing", {3}, {2, 3, 4});
    writer.put_values("/ITKImage/0/Origin", {2}, {10, 20});
  }
  EXPECT_TRUE(contains(refusal(folder / "c.h5"), "expected 3 numbers in '/ITKImage/0/Origin', found 2"));
}

// Each object that a format has may be a link; so may the groups around it.
TEST(Hdf5Places, LinksIntoOtherFilesAreNotFollowed) {
  const TempFolder folder;
  {
    Writer writer(folder / "secret.h5");
    put_imaris(writer);
    writer.put_int16("/ITKImage/0/VoxelData", {2, 3, 4});
    writer.put_values("/ITKImage/0/Spacing", {3}, {2, 3, 4});
    writer.put_values("/ITKImage/0/Origin", {3}, {10, 20, 30});
    writer.put_values("/ITKImage/0/Directions", {3, 3}, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  }
  const auto refused = [&](const std::vector<std::string>& own, const std::vector<std::string>& linked) {
    {
      Writer writer(folder / "a.h5");
      for (const std::string& name : own) {
        name == "/ITKImage/0/VoxelData" ? writer.put_int16(name, {2, 3, 4}) : writer.put_values(name, {3}, {1, 2, 3});
      }
      for (const std::string& name : linked) writer.put_link(name, folder / "secret.h5", name);
    }
    return refusal(folder / "a.h5");
  };
  const std::string data = "/ITKImage/0/VoxelData", spacing = "/ITKImage/0/Spacing", origin = "/ITKImage/0/Origin";
  EXPECT_TRUE(contains(refused({}, {"/ITKImage"}), "expected '/ITKImage/0/VoxelData' in the file itself"));
  EXPECT_TRUE(contains(refused({}, {data}), "found a link to '/ITKImage/0/VoxelData' in '"));
  EXPECT_TRUE(contains(refused({data, origin}, {spacing}), "expected '/ITKImage/0/Spacing' in the file itself"));
  EXPECT_TRUE(contains(refused({}, {"/DataSet", "/DataSetInfo"}), "expected '/DataSetInfo/Image' in the file itself"));
}

TEST(Hdf5Places, NumbersInOtherFilesAreNotRead) {
  const TempFolder folder;
  folder.put("numbers", std::string(24, 'x'));
  {
    Writer writer(folder / "a.h5");
    writer.put_int16("/ITKImage/0/VoxelData", {2, 3, 4});
    const hsize_t count = 3;
    const hid_t space = H5Screate_simple(1, &count, nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(creation, (folder / "numbers").c_str(), 0, 24);
    H5Dclose(
        H5Dcreate2(writer.file(), "/ITKImage/0/Spacing", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation);
    H5Sclose(space);
  }
  EXPECT_TRUE(contains(refusal(folder / "a.h5"), "expected samples in the file, found external files"));
}

struct MincFields {
  std::string order = "zspace,yspace,xspace";
  std::vector<double> image_min{-10};
  std::vector<double> image_max{90};
};

void put_minc(Writer& writer, const MincFields& fields) {
  const std::string image = "/minc-2.0/image/0/image";
  writer.put_int16(image, {2, 3, 4});
  writer.put_text(image, "dimorder", fields.order, true);
  writer.put_numbers(image, "valid_range", {10, 210});
  writer.put_values("/minc-2.0/image/0/image-min", {fields.image_min.size()}, fields.image_min);
  writer.put_values("/minc-2.0/image/0/image-max", {fields.image_max.size()}, fields.image_max);
  const std::vector<std::vector<double>> cosines{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
  for (const std::size_t axis : {0U, 1U, 2U}) {
    const std::string name = std::string("/minc-2.0/dimensions/") + "xyz"[axis] + "space";
    writer.put_values(name, {1}, {0});
    writer.put_numbers(name, "start", {10.0 * static_cast<double>(axis + 1)});
    writer.put_numbers(name, "step", {axis == 1 ? -3.0 : static_cast<double>(axis) + 2});
    writer.put_numbers(name, "direction_cosines", cosines[axis]);
    writer.put_text(name, "units", "mm", false);
  }
}

TEST(Hdf5Places, MincStartsStepsDirectionsAndValues) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.mnc");
    put_minc(writer, {});
  }
  const auto source = open_volume(folder / "a.mnc");
  const VolumeInfo& info = source->info();
  EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(info.geometry.spacing, (Triple{2, 3, 4}));
  EXPECT_EQ(info.geometry.direction, (std::array<double, 9>{0, 1, 0, 1, 0, 0, 0, 0, 1}));
  // 10 along (0, 1, 0), 20 along (-1, 0, 0), 30 along (0, 0, 1).
  EXPECT_EQ(info.geometry.origin, (Triple{-20, 10, 30}));
  EXPECT_EQ(info.geometry.space, Space::kRas);
  EXPECT_EQ(info.geometry.unit, "mm");
  EXPECT_EQ(info.slope, 0.5);
  EXPECT_EQ(info.intercept, -15);
  EXPECT_EQ(samples_of<std::int16_t>(*source), counting(24));
}

TEST(Hdf5Places, MincAxesInAnotherOrder) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.mnc");
    put_minc(writer, {"xspace,zspace,yspace", {-10, -10}, {90, 90}});
  }
  const auto source = open_volume(folder / "a.mnc");
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{2, 4, 3}));
  EXPECT_EQ(source->info().geometry.spacing, (Triple{2, 3, 4}));
  // Sample (x, y, z) = (1, 2, 0) is number 12 + 2.
  EXPECT_EQ(samples_of<std::int16_t>(*source).at(1 + 2 * 2), 15);
}

TEST(Hdf5Places, MincScalingsOfSlicesGiveValues) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.mnc");
    put_minc(writer, {"zspace,yspace,xspace", {0, 1}, {90, 90}});
    Writer other(folder / "b.mnc");
    put_minc(other, {"xspace,yspace,zspace", {0, 1}, {90, 90}});
  }
  const auto source = open_volume(folder / "a.mnc");
  EXPECT_EQ(source->info().type, SampleType::kFloat32);
  EXPECT_EQ(source->info().slope, 1);
  EXPECT_TRUE(contains(source->info().notes.at(0), "the scaling changes along axis 2: samples are read as values"));
  const auto values = samples_of<float>(*source, 1);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double sample = static_cast<double>(n + 1);
    EXPECT_FLOAT_EQ(values[n], static_cast<float>(n < 12 ? 0.45 * (sample - 10) : 0.445 * (sample - 10) + 1)) << n;
  }
  const auto skipped = open_volume(folder / "a.mnc");
  std::vector<float> last(12);
  skipped->read(1, 1, std::as_writable_bytes(std::span(last)));
  EXPECT_TRUE(std::equal(last.begin(), last.end(), values.begin() + 12));
  // The slowest axis of the file is that of the columns.
  const auto turned = open_volume(folder / "b.mnc");
  EXPECT_EQ(turned->info().dims, (std::array<std::int64_t, 3>{2, 3, 4}));
  const auto columns = samples_of<float>(*turned, 1);
  EXPECT_FLOAT_EQ(columns[0], 0.45F * -9);
  EXPECT_FLOAT_EQ(columns[1], 0.445F * 3 + 1);
  EXPECT_FLOAT_EQ(columns[2], 0.45F * -5);
}

TEST(Hdf5Places, WrongMincHeadersAreRefused) {
  const TempFolder folder;
  const auto refused = [&folder](const MincFields& fields) {
    {
      Writer writer(folder / "a.mnc");
      put_minc(writer, fields);
    }
    return refusal(folder / "a.mnc");
  };
  EXPECT_TRUE(contains(refused({"zspace,yspace", {0}, {90}}), "expected 3 names of axes in dimorder"));
  EXPECT_TRUE(
      contains(refused({"zspace,yspace,xspace", {0, 0, 1}, {9, 9, 9}}), "image-min and image-max for each index"));
  EXPECT_TRUE(contains(refused({"zspace,yspace,xspace", {0, 1}, {9}}), "expected 2 values in image-max"));
  EXPECT_TRUE(contains(refused({"zspace,yspace,xspace", {0}, {1e300}}), "expected values that fit in float32"));
  EXPECT_TRUE(contains(refused({"zspace,yspace,xspace", {0}, {std::nan("")}}), "expected values that fit in float32"));
}

TEST(Hdf5Places, VtkImagesBeginWhereTheirExtentDoes) {
  const TempFolder folder;
  for (const std::string type : {"ImageData", "UnstructuredGrid"}) {
    Writer writer(folder / (type + ".vtkhdf"));
    writer.put_int16("/VTKHDF/PointData/values", {2, 3, 4});
    writer.put_text("/VTKHDF", "Type", type, true);
    writer.put_numbers("/VTKHDF", "WholeExtent", {1, 4, 0, 2, -2, -1});
    writer.put_numbers("/VTKHDF", "Origin", {10, 20, 30});
    writer.put_numbers("/VTKHDF", "Spacing", {2, 3, 4});
    writer.put_numbers("/VTKHDF", "Direction", {0, -1, 0, 1, 0, 0, 0, 0, 1});
  }
  const auto source = open_volume(folder / "ImageData.vtkhdf");
  const Geometry& geometry = source->info().geometry;
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(geometry.spacing, (Triple{2, 3, 4}));
  EXPECT_EQ(geometry.direction, (std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 1}));
  // One step along i, which is y in the world, and two back along k.
  EXPECT_EQ(geometry.origin, (Triple{10, 22, 22}));
  EXPECT_EQ(samples_of<std::int16_t>(*source), counting(24));
  EXPECT_EQ(open_volume(folder / "UnstructuredGrid.vtkhdf")->info().geometry.spacing, (Triple{1, 1, 1}));
}

TEST(Hdf5Places, Dream3dSamplesAreInTheMiddleOfCells) {
  const TempFolder folder;
  const std::string path = folder / "a.dream3d";
  {
    Writer writer(path);
    writer.put_int16("/DataContainers/Image/CellData/Values", {2, 3, 4, 1});
    writer.put_int16("/DataContainers/Image/CellData/Angles", {2, 3, 4, 3});
    writer.put_int16("/DataContainers/Image/Other/Values", {2, 2, 2, 1});
    writer.put_values("/DataContainers/Image/_SIMPL_GEOMETRY/DIMENSIONS", {3}, {4, 3, 2});
    writer.put_values("/DataContainers/Image/_SIMPL_GEOMETRY/ORIGIN", {3}, {10, 20, 30});
    writer.put_values("/DataContainers/Image/_SIMPL_GEOMETRY/SPACING", {3}, {0.5, 1, 2});
  }
  OpenOptions options;
  options.dataset = "DataContainers/Image/CellData/Values";
  const auto source = open_volume(path, options);
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(source->info().geometry.spacing, (Triple{0.5, 1, 2}));
  EXPECT_EQ(source->info().geometry.origin, (Triple{10.25, 20.5, 31}));
  EXPECT_EQ(samples_of<std::int16_t>(*source), counting(24));
  options.dataset = "/DataContainers/Image/CellData/Angles";
  options.channel = 2;
  EXPECT_EQ(read_file<std::int16_t>(path, options).at(1), 6);
  options = {};
  options.dataset = "/DataContainers/Image/Other/Values";
  EXPECT_EQ(open_volume(path, options)->info().geometry.spacing, (Triple{1, 1, 1}));
}

}  // namespace
}  // namespace isoweave::testing::volume_hdf5_places_test
