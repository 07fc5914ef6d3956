// HDF5: files written through the library itself.
#include "hdf5_helpers.hpp"
#include "index_helpers.hpp"
#include "volume/formats/chunked/lzf.hpp"
#include "volume/formats/hdf5/hdf5_library.hpp"

namespace isoweave::testing::volume_hdf5_test {
namespace {

TEST(Hdf5, LayoutsAndFilters) {
  const TempFolder folder;
  const auto compact = [](hid_t creation) { H5Pset_layout(creation, H5D_COMPACT); };
  const auto gzip = [](hid_t creation) {
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 4);
    H5Pset_fletcher32(creation);
  };
  const auto szip = [](hid_t creation) { H5Pset_szip(creation, H5_SZIP_NN_OPTION_MASK, 8); };
  struct Case {
    std::string name;
    std::function<void(hid_t)> set_up;
  };
  std::vector<Case> cases{{"contiguous", [](hid_t) {}},      {"compact", compact},
                          {"chunked", chunks({2, 3, 4})},    {"whole", chunks({5, 7, 9})},
                          {"gzip", chunks({2, 3, 4}, gzip)}, {"thin", chunks({5, 1, 2}, gzip)}};
  if (H5Zfilter_avail(H5Z_FILTER_SZIP) > 0) cases.push_back({"szip", chunks({2, 3, 8}, szip)});
  for (const Case& entry : cases) {
    const std::string path = folder / (entry.name + ".h5");
    Writer(path).put_int16("/group/volume", {5, 7, 9}, entry.set_up);
    for (const std::int64_t at_once : {1, 2, 5}) {
      EXPECT_EQ(samples_of<std::int16_t>(*open_volume(path), at_once), counting(315)) << entry.name << at_once;
    }
    const VolumeInfo info = open_volume(path)->info();
    EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{9, 7, 5})) << entry.name;
    EXPECT_EQ(info.format, "hdf5");
    EXPECT_EQ(info.part, "dataset /group/volume");
  }
}

TEST(Hdf5, TypesAndByteOrders) {
  const TempFolder folder;
  const std::string path = folder / "a.h5";
  {
    Writer writer(path);
    writer.put<std::uint32_t>("/u32", {2, 2, 2}, H5T_STD_U32BE, H5T_NATIVE_UINT32);
    writer.put<double>("/f64", {2, 2, 2}, H5T_IEEE_F64BE, H5T_NATIVE_DOUBLE);
    writer.put<float>("/f32", {2, 2, 2}, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT);
    writer.put<std::int8_t>("/i8", {2, 2, 2}, H5T_STD_I8LE, H5T_NATIVE_INT8);
    writer.put<std::int64_t>("/i64", {2, 2, 2}, H5T_STD_I64LE, H5T_NATIVE_INT64);
    const hid_t truth = H5Tenum_create(H5T_NATIVE_INT8);
    const std::int8_t no = 0, yes = 1;
    H5Tenum_insert(truth, "FALSE", &no);
    H5Tenum_insert(truth, "TRUE", &yes);
    writer.put<std::int8_t>("/bool", {1, 1, 1}, truth, truth);
    H5Tclose(truth);
  }
  OpenOptions options;
  const auto open = [&](const std::string& name) {
    options.dataset = name;
    return open_volume(path, options);
  };
  EXPECT_EQ(samples_of<std::uint32_t>(*open("/u32")).at(7), 8U);
  EXPECT_EQ(samples_of<double>(*open("f64")).at(7), 8);
  EXPECT_EQ(samples_of<float>(*open("/f32")).at(7), 8);
  EXPECT_EQ(samples_of<std::int8_t>(*open("/i8")).at(7), 8);
  EXPECT_EQ(samples_of<std::int8_t>(*open("/bool")).at(0), 1);
  EXPECT_EQ(samples_of<std::int64_t>(*open("/i64")).at(7), 8);
  EXPECT_TRUE(
      contains(refusal(path), "expected --dataset with one of '/bool' (1 x 1 x 1 int8), '/f32' (2 x 2 x 2 float32)"));
  options.dataset = "/nothing";
  EXPECT_TRUE(contains(refusal(path, options), "expected a dataset '/nothing'"));
  options.dataset = "/";
  EXPECT_TRUE(contains(refusal(path, options), "expected a dataset '/', found a group"));
}

// A float of two bytes, by its fields and its bias.
hid_t half_type(std::size_t bias) {
  const hid_t half = H5Tcopy(H5T_IEEE_F32LE);
  H5Tset_fields(half, 15, 10, 5, 0, 10);
  H5Tset_size(half, 2);
  H5Tset_ebias(half, bias);
  return half;
}

TEST(Hdf5, HalvesAreReadAsFloats) {
  const TempFolder folder;
  const hid_t half = half_type(15);
  for (const H5T_order_t order : {H5T_ORDER_LE, H5T_ORDER_BE}) {
    H5Tset_order(half, order);
    Writer(folder / "b.h5").put<float>("/v", {2, 2, 3}, half, H5T_NATIVE_FLOAT);
    std::vector<float> expected(12);
    for (std::size_t n = 0; n < expected.size(); ++n) expected[n] = static_cast<float>(n + 1);
    EXPECT_EQ(read_file<float>(folder / "b.h5"), expected);
  }
  H5Tclose(half);
}

TEST(Hdf5, TheOnlyDatasetOfATypeThatIsNotReadIsNamed) {
  const TempFolder folder;
  {
    const hid_t odd = half_type(14);
    Writer(folder / "b.h5").put<float>("/v", {2, 2, 2}, odd, H5T_NATIVE_FLOAT);
    H5Tclose(odd);
  }
  EXPECT_TRUE(contains(refusal(folder / "b.h5"), "in '/v', found float16"));
}

TEST(Hdf5, TheMagicMayLieBehindABlockOfTheUser) {
  const TempFolder folder;
  Writer(folder / "a.mat", 1024).put_int16("/v", {2, 2, 2});
  EXPECT_EQ(read_file<std::int16_t>(folder / "a.mat"), counting(8));
}

TEST(Hdf5, MayBeInGzip) {
  const TempFolder folder;
  Writer(folder / "a.h5").put_int16("v", {2, 3, 4});
  const std::string packed = folder.put("b.h5.gz", gzipped(get(folder / "a.h5")));
  EXPECT_EQ(read_file<std::int16_t>(packed), read_file<std::int16_t>(folder / "a.h5"));
  EXPECT_EQ(open_volume(packed)->info().path, packed);
  EXPECT_EQ(folder.entries(), 2u);
}

TEST(Hdf5, AttributesSayWhereSamplesLie) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.h5");
    writer.put_int16("/v", {2, 2, 2});
    writer.put_numbers("/v", "element_size_um", {2, 0.5, 0.25});
    writer.put_numbers("/v", "offset", {30, 20, 10});
  }
  const Geometry microns = open_volume(folder / "a.h5")->info().geometry;
  EXPECT_EQ(microns.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(microns.spacing, (std::array<double, 3>{0.25, 0.5, 2}));
  EXPECT_EQ(microns.unit, "um");
  {
    Writer writer(folder / "b.h5");
    writer.put_int16("/v", {2, 2, 2});
    writer.put_numbers("/v", "resolution", {40, 4, 8});
    writer.put_numbers("/v", "offset", {400, 0, 80});
    writer.put_text("/v", "units", "nm", true);
  }
  const Geometry nanometres = open_volume(folder / "b.h5")->info().geometry;
  EXPECT_EQ(nanometres.spacing, (std::array<double, 3>{8, 4, 40}));
  EXPECT_EQ(nanometres.origin, (std::array<double, 3>{80, 0, 400}));
  EXPECT_EQ(nanometres.unit, "nm");
}

// netCDF-4: values of packed samples, and coordinates along axes.
TEST(Hdf5, SamplesArePackedByAFactorAndAnOffset) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.nc");
    writer.put_int16("/v", {2, 2, 2});
    writer.put_numbers("/v", "scale_factor", {0.5});
    writer.put_numbers("/v", "add_offset", {100});
    writer.put_numbers("/v", "_FillValue", {-9});
    writer.put_text("/v", "_Unsigned", "true", true);
    Writer other(folder / "b.nc");
    other.put_int16("/v", {2, 2, 2});
    other.put_numbers("/v", "scale_factor", {0});
    other.put_numbers("/v", "add_offset", {1, 2});
    other.put_numbers("/v", "missing_value", {std::nan("")});
  }
  const VolumeInfo packed = open_volume(folder / "a.nc")->info();
  EXPECT_EQ(packed.slope, 0.5);
  EXPECT_EQ(packed.intercept, 100);
  EXPECT_TRUE(has_note(packed, "attribute _FillValue (-9) is not applied"));
  EXPECT_TRUE(has_note(packed, "attribute _Unsigned is not applied: samples are read as int16"));
  const VolumeInfo plain = open_volume(folder / "b.nc")->info();
  EXPECT_EQ(plain.slope, 1);
  EXPECT_EQ(plain.intercept, 0);
  EXPECT_TRUE(has_note(plain, "attribute scale_factor is 0 and is left out"));
  EXPECT_TRUE(has_note(plain, "attribute add_offset is no finite number and is left out"));
  EXPECT_FALSE(has_note(plain, "missing_value"));
  // NeXus keeps both beside the dataset.
  {
    Writer writer(folder / "c.nxs");
    writer.put_int16("/entry/data/v", {2, 2, 2});
    writer.put_text("/entry/data", "NX_class", "NXdata", true);
    writer.put_values("/entry/data/v_scaling_factor", {1}, {0.5});
    writer.put_values("/entry/data/offset", {1}, {2});
  }
  const VolumeInfo nexus = open_volume(folder / "c.nxs")->info();
  EXPECT_TRUE(has_note(nexus, "the dataset 'v_scaling_factor' is not applied"));
  EXPECT_TRUE(has_note(nexus, "the dataset 'offset' is not applied"));
}

// A dataset of 4 x 3 x 2 samples, and its coordinates: x in micrometres, y descending, z packed.
void put_netcdf(Writer& writer, const std::string& unit = "mm") {
  writer.put_int16("/g/v", {2, 3, 4});
  writer.put_values("/g/x", {4}, {10, 10.5, 11, 11.5});
  writer.put_values("/g/y", {3}, {5, 3, 1});
  writer.put_values("/g/z", {2}, {1, 2});
  writer.put_numbers("/g/z", "scale_factor", {4});
  writer.put_text("/g/x", "units", unit, true);
}

TEST(Hdf5, ScalesSayWhereSamplesLie) {
  const TempFolder folder;
  const auto expect_places = [&folder] {
    const VolumeInfo info = open_volume(folder / "a.nc")->info();
    EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{4, 3, 2}));
    EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{0.5, 2, 4}));
    EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{10, 5, 4}));
    EXPECT_EQ(info.geometry.direction, (std::array<double, 9>{1, 0, 0, 0, -1, 0, 0, 0, 1}));
    EXPECT_EQ(info.geometry.unit, "mm");
    EXPECT_FALSE(has_note(info, "spacing"));
  };
  {
    Writer writer(folder / "a.nc");
    put_netcdf(writer);
    writer.put_scales("/g/v", {"/g/z", "/g/y", "/g/x"});
  }
  expect_places();
  // Datasets of the names of the axes.
  {
    Writer writer(folder / "a.nc");
    put_netcdf(writer);
    writer.put_text("/g/v", "axistags", R"({"axes": [{"key": "z"}, {"key": "y"}, {"key": "x"}]})", false);
  }
  expect_places();
  // Attributes of the dataset come first.
  {
    Writer writer(folder / "a.nc");
    put_netcdf(writer);
    writer.put_scales("/g/v", {"/g/z", "/g/y", "/g/x"});
    writer.put_numbers("/g/v", "element_size_um", {3, 2, 1});
  }
  EXPECT_EQ(open_volume(folder / "a.nc")->info().geometry.spacing, (std::array<double, 3>{1, 2, 3}));
}

TEST(Hdf5, ScalesNameAxes) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.nc");
    writer.put_int16("/v", {4, 3, 2});
    writer.put_values("/x", {4}, {0, 1, 2, 3});
    writer.put_values("/y", {3}, {0, 1, 2});
    writer.put_values("/depth", {2}, {0, 0});
    writer.put_text("/depth", "NAME", "This is a netCDF dimension but not a netCDF variable.         2", true);
    writer.put_scales("/v", {"/x", "/y", "/depth"});
  }
  const auto turned = open_volume(folder / "a.nc");
  EXPECT_EQ(turned->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_TRUE(has_note(turned->info(), "axis 'depth' is taken for z"));
  EXPECT_TRUE(has_note(turned->info(), "the spacing of axis 2 is not given and taken as 1"));
  EXPECT_EQ(samples_of<std::int16_t>(*turned).at(1), 7);
  // Names that are not known are no reason to refuse what their order says.
  {
    Writer writer(folder / "b.nc");
    writer.put_int16("/v", {2, 2, 3, 4});
    writer.put_values("/x", {4}, {0, 1, 2, 3});
    writer.put_values("/y", {3}, {0, 1, 2});
    writer.put_values("/member", {2}, {0, 1});
    writer.put_scales("/v", {"/member", "/member", "/y", "/x"});
  }
  OpenOptions options;
  options.channel = 1;
  const VolumeInfo ordered = open_volume(folder / "b.nc", options)->info();
  EXPECT_EQ(ordered.dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_TRUE(has_note(ordered, "the names of the axes of 2 ('member') x 2 ('member') x 3 ('y') x 4 ('x')"));
}

TEST(Hdf5, CoordinatesThatGiveNoStepAreNoted) {
  const TempFolder folder;
  const auto note = [&folder](const std::string& name, const std::function<void(Writer&)>& put) {
    {
      Writer writer(folder / "a.nc");
      writer.put_int16("/v", {3, 3, 4});
      put(writer);
      writer.put_scales("/v", {name, "", ""});
    }
    const VolumeInfo info = open_volume(folder / "a.nc")->info();
    EXPECT_EQ(info.geometry.spacing, (std::array<double, 3>{1, 1, 1}));
    EXPECT_EQ(info.geometry.origin, (std::array<double, 3>{0, 0, 0}));
    return info.notes.at(3);
  };
  const auto values = [](const std::vector<double>& list, const std::string& unit) {
    return [list, unit](Writer& writer) {
      writer.put_values("/z", {list.size()}, list);
      if (!unit.empty()) writer.put_text("/z", "units", unit, false);
    };
  };
  const std::string begin = "the coordinates 'z' of axis 2 are ", end = ": its spacing is taken as 1";
  EXPECT_EQ(note("/z", values({0, 2.1, 4}, "m")), begin + "not evenly spaced" + end);
  EXPECT_EQ(note("/z", values({1, 1, 1}, "")), begin + "not evenly spaced" + end);
  EXPECT_EQ(note("/z", values({0, std::nan(""), 2}, "")), begin + "not evenly spaced" + end);
  EXPECT_EQ(note("/z", values({0, 2}, "m")), begin + "2 for 3 samples" + end);
  for (const std::string unit : {"degrees_north", "days since 2000-01-01", "hPa"}) {
    EXPECT_EQ(note("/z", values({0, 2, 4}, unit)), begin + "in '" + unit + "', which is no length that is known" + end);
  }
  const auto texts = [](Writer& writer) { writer.put<char>("/z", {3}, H5T_C_S1, H5T_C_S1); };
  EXPECT_EQ(note("/z", texts), begin + "no numbers that can be read" + end);
}

TEST(Hdf5, AxesByTheTagsOfIlastik) {
  const TempFolder folder;
  for (const bool fixed : {false, true}) {
    Writer writer(folder / "a.h5");
    writer.put_int16("/v", {2, 3, 4, 2}, chunks({1, 2, 3, 1}));
    writer.put_text("/v", "axistags",
                    R"({"axes": [{"key": "z", "typeFlags": 2}, {"key": "y"}, {"key": "x"}, {"key": "c"}]})", fixed);
  }
  OpenOptions options;
  options.channel = 1;
  const auto source = open_volume(folder / "a.h5", options);
  EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  const auto samples = samples_of<std::int16_t>(*source, 1);
  for (std::size_t n = 0; n < samples.size(); ++n) EXPECT_EQ(samples[n], 2 * static_cast<int>(n) + 2);
  {
    Writer writer(folder / "b.h5");
    writer.put_int16("/v", {4, 3, 2}, chunks({3, 2, 1}));
    writer.put_text("/v", "axistags", R"({"axes": [{"key":"x"}, {"key":"y"}, {"key":"z"}]})", false);
  }
  const auto turned = open_volume(folder / "b.h5");
  EXPECT_EQ(turned->info().dims, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(samples_of<std::int16_t>(*turned, 1),
            (std::vector<std::int16_t>{1, 7, 13, 19, 3, 9,  15, 21, 5, 11, 17, 23,
                                       2, 8, 14, 20, 4, 10, 16, 22, 6, 12, 18, 24}));
}

TEST(Hdf5, SamplesThatWereNeverWrittenAreTheFillValue) {
  const TempFolder folder;
  {
    Writer writer(folder / "a.h5");
    const Shape shape{2, 2, 2}, chunk{1, 2, 2};
    const hid_t space = H5Screate_simple(3, shape.data(), nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
    const std::int16_t fill = -5;
    H5Pset_fill_value(creation, H5T_NATIVE_INT16, &fill);
    H5Pset_chunk(creation, 3, chunk.data());
    H5Dclose(H5Dcreate2(writer.file(), "/v", H5T_STD_I16LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation);
    H5Sclose(space);
  }
  EXPECT_EQ(read_file<std::int16_t>(folder / "a.h5"), std::vector<std::int16_t>(8, -5));
}

TEST(Hdf5, ClaimsBeyondWhatIsStoredAreRefused) {
  const TempFolder folder;
  const auto put = [&folder](const Shape& shape, const Shape& chunk) {
    Writer writer(folder / "a.h5");
    const hid_t space = H5Screate_simple(3, shape.data(), nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, 3, chunk.data());
    H5Dclose(H5Dcreate2(writer.file(), "/v", H5T_STD_I16LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation);
    H5Sclose(space);
  };
  put({2, 1 << 20, 1 << 20}, {1, 64, 64});
  EXPECT_TRUE(contains(refusal(folder / "a.h5"), "which cannot hold them"));
  put({1 << 30, 1 << 30, 1 << 30}, {1, 64, 64});
  EXPECT_TRUE(contains(refusal(folder / "a.h5"), "fewer than 2^63 bytes"));
}

TEST(Hdf5, FiltersThatAreNotThereAreNamed) {
  const TempFolder folder;
  Writer(folder / "a.h5").put_int16("/v", {2, 2, 2}, chunks({1, 2, 2}, [](hid_t creation) {
                                      H5Pset_filter(creation, 32008, H5Z_FLAG_OPTIONAL, 0, nullptr);
                                    }));
  EXPECT_TRUE(contains(refusal(folder / "a.h5"), "found bitshuffle"));
}

TEST(Hdf5, LinksIntoOtherFilesAreNotFollowed) {
  const TempFolder folder;
  Writer(folder / "secret.h5").put_int16("/v", {2, 2, 2});
  {
    Writer writer(folder / "a.h5");
    H5Lcreate_external((folder / "secret.h5").c_str(), "/v", writer.file(), "outside", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_hard(writer.file(), "/", writer.file(), "itself", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/itself/outside", writer.file(), "soft", H5P_DEFAULT, H5P_DEFAULT);
    writer.put_link("/group", "secret.h5", "/");
  }
  EXPECT_TRUE(contains(refusal(folder / "a.h5"),
                       "expected a dataset of numbers of 2 axes or more, found none; links "
                       "into other files, such as '/group', are not followed"));
  OpenOptions options;
  for (const std::string name : {"outside", "/itself/outside", "soft", "group/v", "group"}) {
    options.dataset = name;
    const std::string message = refusal(folder / "a.h5", options);
    EXPECT_TRUE(contains(message, "/" + name.substr(name[0] == '/' ? 1 : 0) + "' in the file itself, found a link to"))
        << message;
    EXPECT_TRUE(contains(message, "secret.h5', which is not followed")) << message;
  }
  Writer(folder / "a.h5").put_int16("/w", {2, 2, 2});
  EXPECT_EQ(read_file<std::int16_t>(folder / "a.h5"), counting(8));
}

TEST(Hdf5, TheCallersPrinterOfErrorsIsLeftAlone) {
  const TempFolder folder;
  const auto printer = [](hid_t, void*) -> herr_t { return 0; };
  H5E_auto2_t before = nullptr, after = nullptr;
  void* data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  H5Eset_auto2(H5E_DEFAULT, printer, nullptr);
  EXPECT_TRUE(
      contains(refusal(folder.put("a.h5", "\x89HDF\r\n\x1a\n and nothing more")), "expected a readable HDF5 file"));
  H5Eget_auto2(H5E_DEFAULT, &after, &data);
  EXPECT_EQ(after, static_cast<H5E_auto2_t>(printer));
  H5Eset_auto2(H5E_DEFAULT, before, data);
}

TEST(Hdf5, FilesThatAreCutAreRefused) {
  const TempFolder folder;
  Writer(folder / "good.h5").put_int16("/v", {5, 7, 9}, chunks({2, 3, 4}, [](hid_t p) { H5Pset_deflate(p, 4); }));
  const std::string good = get(folder / "good.h5");
  for (std::size_t length = 1; length < good.size(); length += 1 + length % 7) {
    EXPECT_FALSE(reads_or_refuses(folder.put("cut.h5", good.substr(0, length)))) << length;
  }
}

std::string lzf(const std::string& stored, std::size_t bytes) {
  std::string out(bytes, '?');
  const bool good = decode_lzf(std::as_bytes(std::span(stored)), std::as_writable_bytes(std::span(out)));
  return good ? out : "(refused)";
}

TEST(Lzf, RunsAndCopies) {
  EXPECT_EQ(lzf(std::string("\x02") + "abc", 3), "abc");
  // A copy of 3 from 3 back, then one of 7 + 2 + 4 from 1 back.
  EXPECT_EQ(lzf(std::string("\x02") + "abc" + std::string("\x20\x02\xe0\x04\x00", 5), 19),
            "abcabc" + std::string(13, 'c'));
  EXPECT_EQ(lzf(std::string("\x02") + "abc", 4), "(refused)");
  EXPECT_EQ(lzf(std::string("\x02") + "abc", 2), "(refused)");
  EXPECT_EQ(lzf(std::string("\x03") + "abc", 4), "(refused)");
  EXPECT_EQ(lzf(std::string("\x02") + "abc" + "\x20\x03", 6), "(refused)");
  EXPECT_EQ(lzf(std::string("\x02") + "abc" + "\xe0\x04", 16), "(refused)");
  EXPECT_EQ(lzf(std::string("\x02") + "abc" + "\x20", 6), "(refused)");
}

TEST(Hdf5, ChunksThatTheSurfaceMissesAreNotRead) {
  const TempFolder folder;
  Writer(folder / "a.h5").put_int16("/v", {60, 30, 17}, chunks({20, 8, 10}, [](hid_t p) { H5Pset_deflate(p, 4); }));
  const MeshReport report = expect_same_with_index(folder / "a.h5", 4000.5, Normals::kGradient);
  EXPECT_EQ(report.left_out->chunks, 24U);
  EXPECT_EQ(report.left_out->chunks_left_out, 16U);
  EXPECT_EQ(report.left_out->bytes_left_out, 2U * 40 * 30 * 17);
  Writer(folder / "plain.h5").put_int16("/v", {60, 30, 17});
  EXPECT_EQ(expect_same_with_index(folder / "plain.h5", 4000.5).left_out->chunks, 0U);
}

}  // namespace
}  // namespace isoweave::testing::volume_hdf5_test
