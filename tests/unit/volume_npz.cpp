// Archives of arrays as numpy.savez and numpy.savez_compressed write them.
#include "foreign_meshes.hpp"
#include "header_helpers.hpp"

namespace isoweave::testing::volume_npz_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);
const std::string kVolume = npy_header("<i2", "(5, 2, 3)") + stored(kSamples);
const std::string kPlane = npy_header("<i2", "(2, 3)") + stored(ramp<std::int16_t>(6));
const std::string kObjects = npy_header("|O", "(5, 2, 3)") + std::string(9, 'x');

using Entries = std::vector<std::pair<std::string, std::string>>;

// Stored, or deflated as entries of a zip archive are: without zlib's wrapping.
std::string archive(const Entries& entries, bool packed) {
  if (!packed) return foreign::zip_of(entries);
  std::string bytes;
  std::vector<ZipEntry> directory;
  const auto append = [&](const std::vector<std::byte>& more) {
    bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
  };
  for (const auto& [name, text] : entries) {
    const std::string deflate = deflated(text, -15);
    directory.push_back({name, true, zip_crc(0, text), deflate.size(), text.size(), bytes.size()});
    append(zip_header(directory.back()));
    bytes += deflate;
  }
  append(zip_directory(directory, bytes.size()));
  return bytes;
}

TEST(Npz, TheOnlyVolumeIsRead) {
  const TempFolder folder;
  for (const bool packed : {false, true}) {
    const auto source = open_volume(folder.put("a.npz", archive({{"arr_0.npy", kVolume}}, packed)));
    EXPECT_EQ(source->info().format, "npz");
    EXPECT_EQ(source->info().part, "array arr_0");
    EXPECT_EQ(source->info().dims, (std::array<std::int64_t, 3>{3, 2, 5}));
    EXPECT_EQ(samples_of<std::int16_t>(*source), kSamples);
    // Beside others, of fewer axes or of no numbers.
    const Entries entries{{"affine.npy", kPlane}, {"ct.npy", kVolume}, {"who.npy", kObjects}, {"a.txt", "text"}};
    const std::string path = folder.put("b.npz", archive(entries, packed));
    EXPECT_EQ(read_file<std::int16_t>(path), kSamples);
    EXPECT_EQ(open_volume(path)->info().notes.at(0), "'ct' is the only array of 3 axes or more, and is read");
    EXPECT_EQ(read_file<std::int16_t>(folder.put("c.npz.gz", gzipped(archive(entries, packed)))), kSamples);
    EXPECT_EQ(read_file<std::int16_t>(folder.put("c", archive(entries, packed)))[5], kSamples[5]) << "by content";
    EXPECT_EQ(read_file<std::int16_t>(folder.put("d.NPZ", archive({{"a.txt", "x"}, {"v.npy", kVolume}}, packed))),
              kSamples);
  }
}

TEST(Npz, ANameChooses) {
  const TempFolder folder;
  const Entries entries{{"ct.npy", kVolume}, {"seg.npy", npy_header("|u1", "(1, 2, 3)") + "abcdef"}, {"p.npy", kPlane}};
  const std::string path = folder.put("a.npz", archive(entries, true));
  EXPECT_TRUE(contains(refusal(path),
                       "expected --dataset with one of 'ct' (5 x 2 x 3 int16), 'seg' (1 x 2 x 3 uint8), "
                       "'p' (2 x 3 int16), found no choice"))
      << refusal(path);
  OpenOptions options;
  for (const std::string name : {"seg", "seg.npy"}) {
    options.dataset = name;
    EXPECT_EQ(read_file<std::uint8_t>(path, options), (std::vector<std::uint8_t>{'a', 'b', 'c', 'd', 'e', 'f'}));
  }
  options.dataset = "p";
  EXPECT_EQ(open_volume(path, options)->info().dims, (std::array<std::int64_t, 3>{3, 2, 1}));
  options.dataset = "mri";
  EXPECT_TRUE(contains(refusal(path, options), "expected an array 'mri', found 'ct', 'seg', 'p'"));
  options.dataset = {};
  options.level = 1;
  EXPECT_TRUE(contains(refusal(folder.put("b.npz", archive({{"v.npy", kVolume}}, false)), options), "--level"));
}

TEST(Npz, TheOrderOfFortranAndTimesAreAsInNpy) {
  const TempFolder folder;
  std::vector<std::int16_t> turned;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t k = 0; k < 5; ++k) turned.push_back(kSamples[(k * 2 + j) * 3 + i]);
    }
  }
  for (const bool packed : {false, true}) {
    const std::string fortran = npy_header("<i2", "(5, 2, 3)", true) + stored(turned);
    EXPECT_EQ(read_file<std::int16_t>(folder.put("a.npz", archive({{"v.npy", fortran}}, packed))), kSamples);
    OpenOptions second;
    second.time = 1;
    const std::string times = npy_header("<i2", "(2, 1, 5, 3)") + stored(kSamples);
    const auto source = open_volume(folder.put("a.npz", archive({{"v.npy", times}}, packed)), second);
    EXPECT_EQ(samples_of<std::int16_t>(*source), std::vector<std::int16_t>(kSamples.begin() + 15, kSamples.end()));
  }
}

TEST(Npz, DamageIsFound) {
  const TempFolder folder;
  for (const bool packed : {false, true}) {
    const std::string content = archive({{"v.npy", kVolume}, {"p.npy", kPlane}}, packed);
    expect_prefixes_are_safe(folder, "a.npz", content);
    expect_flips_are_safe(folder, "a.npz", content, content.size(), 1500);
  }
  std::string content = archive({{"v.npy", kVolume}}, false);
  content[content.find(stored(kSamples)) + 7] ^= 1;
  EXPECT_TRUE(contains(refusal(folder.put("a.npz", content)),
                       "expected 'v.npy' as the directory of the archive has it, found another checksum"));
  EXPECT_TRUE(contains(refusal(folder.put("a.npz", archive({{"a.txt", "x"}}, false))),
                       "expected arrays of NumPy in the archive, found none"));
  EXPECT_TRUE(contains(refusal(folder.put("a.npz", archive({{"v.npy", "text"}}, false))), "expected NPY in 'v'"));
  EXPECT_TRUE(contains(refusal(folder.put("a.npz", "text")), "a zip archive of NPY files, found text"));
}

}  // namespace
}  // namespace isoweave::testing::volume_npz_test
