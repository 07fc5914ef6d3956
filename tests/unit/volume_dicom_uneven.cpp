// Slices of DICOM series that do not lie at an even distance, and images that are no slices of it.
#include <cmath>
#include <cstdio>

#include "dicom_helpers.hpp"
#include "volume/even_slices.hpp"

namespace isoweave::testing::volume_dicom_uneven_test {
namespace {

using namespace dicom_files;

// Slices s0, s1, ... of the samples' slices 0, 1, ..., at these places.
void put_at(const TempFolder& folder, const std::vector<double>& places, DicomFields fields = {}) {
  for (std::size_t n = 0; n < places.size(); ++n) {
    fields.position = at(places[n]);
    folder.put("s" + std::to_string(n), dicom(fields, slice(n)));
  }
}

OpenOptions with(UnevenSlices uneven) {
  OpenOptions options;
  options.uneven_slices = uneven;
  return options;
}

std::string all_notes(const VolumeInfo& info) {
  std::string text;
  for (const std::string& note : info.notes) text += note + "\n";
  return text;
}

// What is read on a grid: the slice below each place, then the weight of the one above.
struct Grid {
  EvenGrid grid;
  std::vector<std::string> notes;

  explicit Grid(const std::vector<double>& depths, UnevenSlices uneven = UnevenSlices::kResample) {
    const auto name = [](std::size_t n) { return "s" + std::to_string(n); };
    grid = even_grid({"all", depths, name, name}, uneven, notes);
  }

  double depth(std::int64_t slice) const {
    const auto [lower, weight] = grid.place(slice);
    const double from = grid.depths.at(static_cast<std::size_t>(lower));
    return weight == 0 ? from : from + weight * (grid.depths.at(static_cast<std::size_t>(lower) + 1) - from);
  }
};

TEST(DicomUneven, MakesTheSliceThatIsMissing) {
  const TempFolder folder;
  put_series(folder);
  std::filesystem::remove(folder / "s7");
  const auto source = open_volume(folder / "");
  const VolumeInfo& info = source->info();
  EXPECT_EQ(info.dims[2], 5);
  EXPECT_EQ(info.geometry.spacing[2], 2.5);
  EXPECT_EQ(info.geometry.origin[2], 30);
  EXPECT_EQ(info.part, "slices made at an even distance");
  const std::string notes = all_notes(info);
  EXPECT_TRUE(contains(notes, "1 slice seems to be missing: 5 mm between '")) << notes;
  EXPECT_TRUE(contains(notes, "slices are usually 2.5 mm apart")) << notes;
  EXPECT_TRUE(contains(notes,
                       "the slices are 2.5 to 5 mm apart: they are read as 5 slices 2.5 mm apart, 1 of which is "
                       "interpolated (number 2, from 0)"))
      << notes;
  // The samples rise evenly, so what lies between is what was lost.
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
}

TEST(DicomUneven, SkipsAndReadsByAnyNumberOfSlices) {
  const TempFolder folder;
  put_at(folder, {30, 32.5, 40, 42.5});
  const auto whole = read_file<std::uint16_t>(folder / "");
  ASSERT_EQ(whole.size(), 6 * kSlice);
  EXPECT_EQ(samples_of<std::uint16_t>(*open_volume(folder / ""), 1), whole);
  EXPECT_EQ(samples_of<std::uint16_t>(*open_volume(folder / ""), 6), whole);
  const auto source = open_volume(folder / "");
  std::vector<std::uint16_t> one(kSlice);
  for (const std::int64_t n : {1, 3, 5}) {
    source->read(n, 1, std::as_writable_bytes(std::span(one)));
    EXPECT_TRUE(std::equal(one.begin(), one.end(), whole.begin() + n * static_cast<std::int64_t>(kSlice))) << n;
  }
}

TEST(DicomUneven, RoundsIntegersToTheNearest) {
  const TempFolder folder;
  DicomFields fields;
  fields.is_signed = 1;
  const std::vector<std::int16_t> low(kSlice, -4);
  const std::vector<std::int16_t> high(kSlice, -1);
  fields.position = at(0);
  folder.put("a", dicom(fields, stored(low)));
  fields.position = at(1);
  folder.put("b", dicom(fields, stored(high)));
  fields.position = at(3);
  folder.put("c", dicom(fields, stored(low)));
  fields.position = at(4);
  folder.put("d", dicom(fields, stored(high)));
  const auto source = open_volume(folder / "");
  EXPECT_EQ(source->info().type, SampleType::kInt16);
  const auto samples = samples_of<std::int16_t>(*source);
  ASSERT_EQ(samples.size(), 5 * kSlice);
  // Halfway between -1 and -4 is -2.5.
  EXPECT_EQ(samples[2 * kSlice], -2);
}

TEST(DicomUneven, TakesTheFinerOfTwoDistances) {
  std::vector<double> depths;
  for (int n = 0; n < 33; ++n) depths.push_back(2.5 * n);
  for (int n = 1; n < 12; ++n) depths.push_back(80 + 7.5 * n);
  const Grid grid(depths);
  EXPECT_EQ(grid.grid.count, 66);
  EXPECT_EQ(grid.grid.distance(), 2.5);
  for (std::int64_t n = 0; n < 66; ++n) EXPECT_NEAR(grid.depth(n), 2.5 * static_cast<double>(n), 1e-9) << n;
  ASSERT_EQ(grid.notes.size(), 1);
  EXPECT_EQ(grid.notes[0],
            "the slices are 2.5 to 7.5 mm apart: they are read as 66 slices 2.5 mm apart, 22 of which are interpolated "
            "(numbers 33 to 64, from 0)");
}

TEST(DicomUneven, TakesADistanceThatFewHave) {
  const Grid grid({0, 5, 10, 15, 20, 25, 26, 27, 28, 33, 38});
  EXPECT_EQ(grid.grid.count, 39);
  EXPECT_EQ(grid.grid.distance(), 1);
  std::vector<double> finer{0};
  for (int n = 0; n < 24; ++n) finer.push_back(finer.back() + (n < 14 ? 10 : 1));
  EXPECT_EQ(Grid(finer).grid.count, 151);
  // A slice that lies beside another by mistake does not make the distance.
  std::vector<double> depths;
  for (int n = 0; n < 20; ++n) depths.push_back(2.5 * n);
  depths.insert(depths.begin() + 8, 17.6);
  const Grid twice(depths);
  EXPECT_EQ(twice.grid.count, 20);
  EXPECT_NEAR(twice.grid.distance(), 2.5, 1e-12);
}

TEST(DicomUneven, KeepsBothEndsWhereDistancesDoNotDivideThem) {
  const Grid grid({0, 2, 4, 6, 9, 14});
  EXPECT_EQ(grid.grid.count, 8);
  EXPECT_EQ(grid.grid.distance(), 2);
  const Grid odd({0, 2, 4, 6, 9.5, 13});
  EXPECT_EQ(odd.grid.count, 8);
  EXPECT_NEAR(odd.grid.distance(), 13.0 / 7, 1e-12);
  for (std::int64_t n = 0; n < 8; ++n) {
    EXPECT_NEAR(odd.depth(n), 13.0 / 7 * static_cast<double>(n), 0.01 * 13 / 7) << n;
  }
  EXPECT_EQ(odd.depth(7), 13);
}

TEST(DicomUneven, TakesJitterAsEven) {
  const Grid exact({0, 2.5, 5, 7.5});
  EXPECT_TRUE(exact.notes.empty());
  EXPECT_FALSE(exact.grid.is_resampled);
  const Grid jitter({0, 2.51, 4.99, 7.5});
  EXPECT_FALSE(jitter.grid.is_resampled);
  EXPECT_EQ(jitter.notes.at(0),
            "the slices lie up to 0.01 mm beside an even distance of 2.5 mm: less than a hundredth of it, and taken as "
            "even");
  EXPECT_TRUE(Grid({0, 2.4, 5, 7.5}).grid.is_resampled);
}

// 0.625 mm apart, as files with few digits have it.
TEST(DicomUneven, TakesPositionsThatAreRoundedAsEven) {
  const auto write = [](const TempFolder& folder, int digits, int left_out) {
    for (int n = 0; n < 40; ++n) {
      std::array<char, 64> text;
      DicomFields fields;
      const double unit = std::pow(10.0, -digits);
      std::snprintf(text.data(), text.size(), "10\\20.3125\\%.*f00", digits, std::nearbyint(0.625 * n / unit) * unit);
      fields.position = text.data();
      if (n != left_out) folder.put("s" + std::to_string(n), dicom(fields, slice(static_cast<std::size_t>(n % 5))));
    }
  };
  const TempFolder folder;
  write(folder, 2, -1);
  const VolumeInfo info = open_volume(folder / "")->info();
  EXPECT_EQ(info.dims[2], 40);
  EXPECT_TRUE(info.part.empty());
  EXPECT_TRUE(contains(all_notes(info), "less than their positions are rounded by, and taken as even"))
      << all_notes(info);
  const TempFolder gap;
  write(gap, 2, 20);
  EXPECT_TRUE(contains(all_notes(open_volume(gap / "")->info()), "1 of which is interpolated (number 20, from 0)"));
  // A tenth of a millimetre is too much of it.
  const TempFolder coarse;
  write(coarse, 1, -1);
  EXPECT_FALSE(open_volume(coarse / "")->info().part.empty());
}

// Each gap differs from the next by less than a hundredth, and the slices in the middle lie 1.2 mm off all the same.
TEST(DicomUneven, SeesDistancesThatDrift) {
  std::vector<double> depths{0};
  for (int n = 0; n < 200; ++n) depths.push_back(depths.back() + (n < 100 ? 2.5 : 2.524));
  const Grid grid(depths);
  EXPECT_TRUE(grid.grid.is_resampled);
  for (std::int64_t n = 0; n < grid.grid.count; ++n) {
    EXPECT_NEAR(grid.depth(n), grid.grid.distance() * static_cast<double>(n), 0.026) << n;
  }
}

TEST(DicomUneven, SaysHowManySlicesAreMissingAndWhere) {
  EXPECT_EQ(Grid({0, 2, 4, 10, 12, 14, 18, 20, 22}).notes.at(0),
            "3 slices seem to be missing: 6 mm between 's2' and 's3', 4 mm between 's5' and 's6'; slices are usually 2 "
            "mm apart");
  EXPECT_EQ(Grid({0, 1.3999999653, 2.7999999306, 5.5999998612, 6.9999998265}).notes.at(0),
            "1 slice seems to be missing: 2.8 mm between 's2' and 's3'; slices are usually 1.4 mm apart");
  // Another distance, and one that is no multiple.
  EXPECT_TRUE(contains(Grid({0, 2, 4, 6, 8, 12, 16, 20}).notes.at(0), "the slices are 2 to 4 mm apart"));
  EXPECT_TRUE(contains(Grid({0, 2, 4, 7, 9, 11}).notes.at(0), "the slices are 2 to 3 mm apart"));
}

TEST(DicomUneven, TakesTheMeanOrRefusesWhereAsked) {
  const TempFolder folder;
  put_at(folder, {30, 32.5, 37.5, 40});
  const VolumeInfo mean = open_volume(folder / "", with(UnevenSlices::kMean))->info();
  EXPECT_EQ(mean.dims[2], 4);
  EXPECT_TRUE(mean.part.empty());
  EXPECT_NEAR(mean.geometry.spacing[2], 10.0 / 3, 1e-12);
  EXPECT_TRUE(contains(all_notes(mean), "the mean of 3.333 mm is used, which puts slices up to 0.8333 mm from where"));
  const std::string message = refusal(folder / "", with(UnevenSlices::kRefuse));
  EXPECT_TRUE(contains(message,
                       "expected slices at an even distance (--even-spacing resample or mean reads others), "
                       "found distances of 2.5 to 5 mm, the widest between '"))
      << message;
  put_at(folder, {30, 32.5, 35, 37.5});
  EXPECT_TRUE(open_volume(folder / "", with(UnevenSlices::kRefuse))->info().notes.empty());
}

TEST(DicomUneven, TakesDistancesThatAreGivenForThoseOfTheSlices) {
  const TempFolder folder;
  put_at(folder, {30, 32.5, 37.5, 40});
  OpenOptions options;
  options.spacing = {1, 1, 3};
  const VolumeInfo info = open_volume(folder / "", options)->info();
  EXPECT_EQ(info.dims[2], 4);
  EXPECT_EQ(info.geometry.spacing[2], 3);
  EXPECT_FALSE(contains(all_notes(info), "the mean of"));
  EXPECT_TRUE(contains(all_notes(info), "1 slice seems to be missing"));
  EXPECT_TRUE(contains(all_notes(info), "the one that is given is taken for all of them"));
}

TEST(DicomUneven, RefusesDistancesThatDoNotGoTogether) {
  const TempFolder folder;
  put_at(folder, {0, 1.25, 2.5, 205});
  const std::string message = refusal(folder / "");
  EXPECT_TRUE(contains(message,
                       "expected slices that lie together, with no gap of more than 32 of them, found 202.5 mm between "
                       "'"))
      << message;
  EXPECT_TRUE(contains(message, "where 1.25 mm are usual")) << message;
  put_at(folder, {0, 1.25, 2.5, 42.5});
  EXPECT_EQ(open_volume(folder / "")->info().dims[2], 35);
  EXPECT_EQ(open_volume(folder / "", with(UnevenSlices::kMean))->info().dims[2], 4);
}

TEST(DicomUneven, NotesSlicesBesideTheirLine) {
  const TempFolder folder;
  put_series(folder);
  DicomFields fields;
  fields.position = "10\\21\\35";
  folder.put("s7", dicom(fields, slice(2)));
  EXPECT_TRUE(contains(open_volume(folder / "")->info().notes.at(0), "up to 1 mm beside it"));
}

TEST(DicomUneven, ResamplesTheFramesOfEnhancedImages) {
  const TempFolder folder;
  const auto source = open_volume(folder.put("a", enhanced({frame_at(30), frame_at(32), frame_at(36), frame_at(38)},
                                                           slice(0) + slice(1) + slice(3) + slice(4))));
  EXPECT_EQ(source->info().dims[2], 5);
  EXPECT_EQ(source->info().geometry.spacing[2], 2);
  EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
}

TEST(DicomScaling, ScalesSliceBySliceWhereSlicesDiffer) {
  const TempFolder folder;
  for (std::size_t n = 0; n < 3; ++n) {
    DicomFields fields;
    fields.position = at(static_cast<double>(n));
    fields.slope = std::to_string(1 + 0.25 * static_cast<double>(n));
    fields.intercept = std::to_string(-10.0 * static_cast<double>(n));
    folder.put("s" + std::to_string(n), dicom(fields, slice(n)));
  }
  const auto source = open_volume(folder / "");
  EXPECT_EQ(source->info().type, SampleType::kFloat32);
  EXPECT_EQ(source->info().slope, 1);
  EXPECT_EQ(source->info().intercept, 0);
  EXPECT_TRUE(contains(source->info().notes.at(0), "Rescale Slope 1 to 1.5): samples are read as values"))
      << source->info().notes.at(0);
  const auto values = samples_of<float>(*source);
  for (std::size_t n = 0; n < 3 * kSlice; ++n) {
    const auto k = static_cast<double>(n / kSlice);
    EXPECT_EQ(values[n], static_cast<float>((1 + 0.25 * k) * kSamples[n] - 10 * k)) << n;
  }
}

TEST(DicomScaling, ScalesFramesByTheirOwnGroups) {
  const TempFolder folder;
  const std::string own = group(0x28, 0x9145, element(0x28, 0x1053, "DS", "5"));
  const auto source = open_volume(folder.put("a", enhanced({frame_at(1), frame_at(2) + own}, slice(0) + slice(1))));
  EXPECT_EQ(source->info().type, SampleType::kFloat32);
  const auto values = samples_of<float>(*source);
  EXPECT_EQ(values[3], 2.0F * kSamples[3] - 7);
  EXPECT_EQ(values[kSlice + 3], 5.0F * kSamples[kSlice + 3] - 7);
}

// A slice of nothing may have a slope of 0, where the others have their own.
TEST(DicomScaling, TakesASlopeOfZeroAmongOthers) {
  const TempFolder folder;
  DicomFields fields;
  fields.slope = "0.5";
  folder.put("a", dicom(fields, slice(0)));
  fields.position = at(32);
  fields.slope = "0";
  fields.intercept = "3";
  folder.put("b", dicom(fields, slice(1)));
  const auto values = read_file<float>(folder / "");
  EXPECT_EQ(values[1], 0.5F * kSamples[1]);
  EXPECT_EQ(values[kSlice + 1], 3);
}

TEST(DicomUneven, SurvivesFlips) {
  const TempFolder folder;
  put_at(folder, {30, 32, 36, 38});
  expect_flips_are_safe(folder, "s1", get(folder / "s1"), 600, 1000);
}

TEST(DicomScaling, RefusesValuesThatNoFloatHolds) {
  const TempFolder folder;
  DicomFields fields;
  folder.put("a", dicom(fields, slice(0)));
  fields.position = at(32);
  fields.slope = "1e38";
  folder.put("b", dicom(fields, slice(1)));
  EXPECT_TRUE(contains(refusal(folder / ""), "b: expected values that fit in float32, found samples scaled by 1e+38"));
}

TEST(DicomScouts, AreLeftOutOfASeries) {
  const auto note_with = [](const DicomFields& fields) {
    const TempFolder folder;
    put_series(folder);
    folder.put("scout", dicom(fields, std::string(2 * kSlice * static_cast<std::size_t>(fields.samples), 'x')));
    const auto source = open_volume(folder / "");
    EXPECT_EQ(samples_of<std::uint16_t>(*source), kSamples);
    return all_notes(source->info());
  };
  DicomFields fields;
  fields.orientation = "0\\1\\0\\0\\0\\-1";
  const std::string note = note_with(fields);
  EXPECT_TRUE(contains(note, "1 image of the series is no slice of its volume and is left out: '")) << note;
  EXPECT_TRUE(contains(note, "(in another orientation)")) << note;
  fields = {};
  fields.columns = 5;
  fields.rows = 7;
  EXPECT_TRUE(contains(note_with(fields), "(5 x 7)"));
  fields = {};
  fields.pixel_spacing = "1\\1";
  EXPECT_TRUE(contains(note_with(fields), "(of another pixel spacing)"));
  fields = {};
  fields.more = element(8, 8, "CS", "ORIGINAL\\PRIMARY\\LOCALIZER");
  EXPECT_TRUE(contains(note_with(fields), "(a localizer)"));
  fields = {};
  fields.orientation.clear();
  fields.position.clear();
  EXPECT_TRUE(contains(note_with(fields), "(without an orientation)"));
  fields.samples = 3;
  fields.photometric = "RGB";
  EXPECT_TRUE(contains(note_with(fields), "(in colour)"));
}

TEST(DicomScouts, AreNotGuessedWithoutAMajority) {
  const TempFolder folder;
  DicomFields fields;
  for (const double z : {1.0, 2.0}) {
    fields.position = at(z);
    fields.orientation = "1\\0\\0\\0\\1\\0";
    folder.put("a" + std::to_string(z), dicom(fields, slice(0)));
    fields.orientation = "0\\1\\0\\0\\0\\-1";
    folder.put("b" + std::to_string(z), dicom(fields, slice(0)));
  }
  EXPECT_TRUE(contains(refusal(folder / ""), "expected the orientation and pixel spacing of '"));
  fields = {};
  // Localizers alone are a volume.
  const TempFolder alone;
  fields.more = element(8, 8, "CS", "ORIGINAL\\PRIMARY\\LOCALIZER");
  put_series(alone, fields);
  EXPECT_EQ(open_volume(alone / "")->info().dims[2], 5);
}

}  // namespace
}  // namespace isoweave::testing::volume_dicom_uneven_test
