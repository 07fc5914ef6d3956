// Several volumes in one DICOM series: times, echoes, phases.
#include <algorithm>

#include "dicom_helpers.hpp"

namespace isoweave::testing::volume_dicom_times_test {
namespace {

using namespace dicom_files;

std::string echo(const std::string& time) { return element(0x18, 0x81, "DS", time); }
std::string number(int instance) { return element(0x20, 0x13, "IS", std::to_string(instance)); }
std::string image(int instance) { return element(8, 0x18, "UI", "1.9." + std::to_string(instance)); }

// A slice whose samples are all `value`.
void put_slice(const TempFolder& folder, double z, std::uint16_t value, const std::string& more) {
  static int files = 0;
  DicomFields fields;
  fields.position = at(z);
  fields.more = more + image(files);
  folder.put("s" + std::to_string(files++), dicom(fields, stored(std::vector<std::uint16_t>(kSlice, value))));
}

OpenOptions at_time(std::int64_t time) {
  OpenOptions options;
  options.time = time;
  return options;
}

// The first sample of each slice.
std::vector<std::uint16_t> values(const std::string& path, const OpenOptions& options = {}) {
  const std::vector<std::uint16_t> samples = read_file<std::uint16_t>(path, options);
  std::vector<std::uint16_t> first;
  for (std::size_t n = 0; n < samples.size(); n += kSlice) first.push_back(samples[n]);
  return first;
}

using Values = std::vector<std::uint16_t>;

TEST(DicomTimes, AreVolumesThatATimeTellsApart) {
  const TempFolder folder;
  for (const int z : {2, 0, 1}) {
    put_slice(folder, z, static_cast<std::uint16_t>(100 + z), echo("12.5"));
    put_slice(folder, z, static_cast<std::uint16_t>(200 + z), echo("4.6"));
    put_slice(folder, z, static_cast<std::uint16_t>(300 + z), echo("100"));
  }
  const std::string path = folder / "";
  const auto source = open_volume(path);
  EXPECT_EQ(source->info().notes.at(0), "3 volumes in the same places, told apart by Echo Time (4.6, 12.5, 100)");
  EXPECT_TRUE(contains(source->info().notes.at(1), "the first of 3 along time is read; --time chooses"));
  EXPECT_EQ(source->info().part, "time 0");
  EXPECT_EQ(source->info().data_files.size(), 3U);
  EXPECT_EQ(values(path), (Values{200, 201, 202}));
  EXPECT_EQ(values(path, at_time(1)), (Values{100, 101, 102}));
  EXPECT_EQ(values(path, at_time(2)), (Values{300, 301, 302}));
  EXPECT_TRUE(contains(refusal(path, at_time(3)), "expected --time below 3, found 3"));
}

TEST(DicomTimes, AreToldApartByTwoThingsTogether) {
  const TempFolder folder;
  std::uint16_t value = 0;
  for (const int z : {0, 1}) {
    for (const std::string time : {"10", "9"}) {
      for (const std::string te : {"1", "2"}) {
        put_slice(folder, z, value++, echo(te) + element(0x18, 0x1060, "DS", time));
      }
    }
  }
  const std::string path = folder / "";
  EXPECT_TRUE(contains(open_volume(path)->info().notes.at(0),
                       "4 volumes in the same places, told apart by Trigger Time "
                       "and Echo Time (9/1, 9/2, 10/1, 10/2)"));
  EXPECT_EQ(values(path, at_time(1)), (Values{3, 7}));
  EXPECT_EQ(values(path, at_time(2)), (Values{0, 4}));
}

// Numbers count from place to place or from volume to volume, upwards or downwards. Any other order tells nothing.
TEST(DicomTimes, AreToldApartByTheOrderOfNumbers) {
  const auto read = [](const std::vector<int>& numbers, std::int64_t time) {
    const TempFolder folder;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      put_slice(folder, static_cast<double>(n / 2), static_cast<std::uint16_t>(n), number(numbers[n]));
    }
    try {
      return values(folder / "", at_time(time));
    } catch (const BadInput& error) {
      EXPECT_TRUE(contains(error.what(), "an axis for --time") || contains(error.what(), "--time below 1") ||
                  contains(error.what(), "a position of its own for every slice"))
          << error.what();
      return Values{};
    }
  };
  EXPECT_EQ(read({1, 2, 3, 4, 5, 6}, 1), (Values{1, 3, 5}));
  EXPECT_EQ(read({2, 1, 4, 3, 6, 5}, 1), (Values{0, 2, 4}));
  EXPECT_EQ(read({1, 4, 2, 5, 3, 6}, 1), (Values{1, 3, 5}));
  EXPECT_EQ(read({3, 16, 2, 5, 1, 4}, 0), (Values{0, 2, 4}));
  EXPECT_EQ(read({13, 16, 12, 15, 11, 14}, 1), (Values{1, 3, 5}));
  EXPECT_EQ(read({1, 5, 2, 6, 4, 3}, 0), (Values{})) << "the second volume begins with the last place";
  EXPECT_EQ(read({1, 1, 2, 2, 3, 3}, 0), (Values{})) << "numbers that say nothing";
}

TEST(DicomTimes, ThatContradictThemselvesAreRefused) {
  const TempFolder folder;
  for (const int z : {0, 1, 2}) {
    put_slice(folder, z, 1, echo("1"));
    put_slice(folder, z, 2, echo(z == 1 ? "3" : "2"));
  }
  EXPECT_TRUE(contains(refusal(folder / ""), "a position of its own for every slice"));
  const TempFolder fewer;
  for (const int z : {0, 1, 2}) {
    put_slice(fewer, z, 1, echo("1"));
    if (z != 1) put_slice(fewer, z, 2, echo("2"));
  }
  EXPECT_TRUE(contains(refusal(fewer / ""), "a position of its own for every slice"));
}

// Several images in one place alone are no volumes, as nothing says that they are no slices.
TEST(DicomTimes, AreOfSeveralPlaces) {
  const TempFolder folder;
  put_slice(folder, 1, 1, echo("1") + number(1));
  put_slice(folder, 1, 2, echo("2") + number(2));
  EXPECT_TRUE(contains(refusal(folder / ""), "a position of its own for every slice"));
}

// A value that some places have twice does not tell volumes apart; the order of numbers may.
TEST(DicomTimes, AreToldApartByWhatIsOnceInEveryPlace) {
  const TempFolder folder;
  for (const int z : {0, 1, 2}) {
    put_slice(folder, z, 1, echo(z == 2 ? "2" : "1") + number(z + 1));
    put_slice(folder, z, 2, echo(z == 1 ? "1" : "2") + number(z + 4));
  }
  EXPECT_EQ(values(folder / ""), (Values{1, 1, 1}));
}

// Copies of images need not stand beside them in the order of files.
TEST(DicomTimes, AreFoundBesideCopies) {
  const TempFolder folder;
  DicomFields fields;
  for (const std::string name : {"a", "b"}) {
    for (int n = 0; n < 4; ++n) {
      fields.position = at(n / 2);
      fields.more = echo(std::to_string(n % 2)) + image(n);
      folder.put(name + std::to_string(n), dicom(fields, slice(static_cast<std::size_t>(n))));
    }
  }
  const auto source = open_volume(folder / "");
  EXPECT_TRUE(contains(source->info().notes.at(0), "4 images are copies of others and are left out"));
  EXPECT_TRUE(contains(source->info().notes.at(1), "2 volumes in the same places, told apart by Echo Time (0, 1)"));
}

TEST(DicomTimes, AreNotTakenForSlices) {
  const TempFolder folder;
  put_series(folder);
  OpenOptions options;
  options.slices_from = SliceAxis::kTimes;
  EXPECT_TRUE(contains(refusal(folder / "", options), "for --slices-from, found DICOM, which does"));
  EXPECT_TRUE(contains(refusal(folder / "", at_time(1)), "expected --time below 1, found 1"));
}

// Images side by side at one depth are no volumes.
TEST(DicomTimes, LieInTheSamePlaces) {
  const TempFolder folder;
  DicomFields fields;
  for (int n = 0; n < 4; ++n) {
    fields.position = std::to_string(10 + n % 2 * 5) + "\\20\\" + std::to_string(n / 2);
    fields.more = echo(std::to_string(n % 2)) + image(n);
    folder.put("s" + std::to_string(n), dicom(fields, slice(0)));
  }
  EXPECT_TRUE(contains(refusal(folder / ""), "a position of its own for every slice"));
}

TEST(DicomTimes, OfFramesAreThoseOfTheirGroups) {
  const TempFolder folder;
  const auto frame = [](double z, std::uint32_t index) {
    return group(0x20, 0x9111, element(0x20, 0x9128, "UL", bytes_of(index))) + frame_at(z);
  };
  std::string samples;
  for (std::uint16_t n = 0; n < 6; ++n) samples += stored(std::vector<std::uint16_t>(kSlice, n < 4 ? n : 4));
  const std::vector<std::string> frames{frame(0, 2), frame(0, 1), frame(1, 1), frame(1, 2), frame(2, 1), frame(2, 2)};
  const std::string path = folder.put("a", enhanced(frames, samples));
  EXPECT_TRUE(contains(open_volume(path)->info().notes.at(0), "told apart by Temporal Position Index (1, 2)"));
  EXPECT_EQ(values(path), (Values{1, 2, 4}));
  EXPECT_EQ(values(path, at_time(1)), (Values{0, 3, 4})) << "frames with the same samples are no copies";
  const auto weighted = [](double z, double weight) {
    return group(0x18, 0x9117, element(0x18, 0x9087, "FD", bytes_of(weight))) + frame_at(z);
  };
  const std::string other =
      folder.put("b", enhanced({weighted(0, 1000.5), weighted(0, 0), weighted(1, 1000.5), weighted(1, 0)}, samples));
  EXPECT_TRUE(contains(open_volume(other)->info().notes.at(0), "told apart by Diffusion b-value (0, 1000.5)"));
  EXPECT_EQ(values(other), (Values{1, 3}));
}

}  // namespace
}  // namespace isoweave::testing::volume_dicom_times_test
