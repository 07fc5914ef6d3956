// Volumes in gzip and out of pipes, and what is said of files that are no volume.
// Threads: none, the thread here only feeds a pipe
#include <sys/stat.h>

#include <thread>

#include "files/whole_input.hpp"
#include "header_helpers.hpp"
#include "volume/packed_file.hpp"

namespace isoweave::testing::volume_packed_test {
namespace {

const std::vector<std::int16_t> kSamples = ramp<std::int16_t>(3 * 2 * 5);

std::string nrrd_file(const std::string& samples, const std::string& sizes = "3 2 5") {
  return "NRRD0004\ntype: short\ndimension: 3\nsizes: " + sizes + "\nencoding: raw\nendian: little\n\n" + samples;
}

std::string vti_file() {
  const std::string samples = stored(kSamples);
  return "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt32\"><ImageData WholeExtent=\"0 2 "
         "0 "
         "1 0 4\"><Piece><PointData><DataArray type=\"Int16\" format=\"appended\" offset=\"0\"/></PointData></Piece>"
         "</ImageData><AppendedData encoding=\"raw\">_" +
         bytes_of(static_cast<std::uint32_t>(samples.size())) + samples + "</AppendedData></VTKFile>";
}

std::string legacy_vtk_file() {
  return "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 5\nORIGIN 0 0 0\nSPACING 1 "
         "1 "
         "1\nPOINT_DATA 30\nSCALARS s short\nLOOKUP_TABLE default\n" +
         stored(kSamples, true);
}

std::string metaimage_file() {
  return "NDims = 3\nDimSize = 3 2 5\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" + stored(kSamples);
}

// Every format in one file, by the ending of its name.
std::vector<std::pair<std::string, std::string>> all_files() {
  return {{"a.nrrd", nrrd_file(stored(kSamples))},
          {"a.mha", metaimage_file()},
          {"a.vti", vti_file()},
          {"a.vtk", legacy_vtk_file()},
          {"a.nii", nifti_header({}) + stored(kSamples)},
          {"a.pvm", "PVM\n3 2 5\n2\n" + stored(kSamples, true)},
          {"a.npy", npy_header("<i2", "(5, 2, 3)") + stored(kSamples)},
          {"a.mrc", mrc_header({}) + stored(kSamples)},
          {"a.mgh", mgh_header({}) + stored(kSamples, true)},
          {"a_3x2x5_int16.raw", stored(kSamples)}};
}

// Numbers that do not compress.
std::vector<std::int16_t> noise(std::size_t count) {
  std::mt19937 random(7);
  std::vector<std::int16_t> samples(count);
  for (std::int16_t& sample : samples) sample = static_cast<std::int16_t>(random());
  return samples;
}

TEST(Packed, ReadsEveryFormatInGzip) {
  const TempFolder folder;
  for (const auto& [name, content] : all_files()) {
    const std::string plain = folder.put(name, content);
    const std::string packed = folder.put(name + ".gz", gzipped(content));
    EXPECT_EQ(read_file<std::int16_t>(packed), kSamples) << name;
    EXPECT_EQ(open_volume(packed)->info().format, open_volume(plain)->info().format);
    EXPECT_EQ(open_volume(packed)->info().geometry.origin, open_volume(plain)->info().geometry.origin);
    // The name says nothing, but where the content does not.
    if (!contains(name, "raw")) {
      EXPECT_EQ(read_file<std::int16_t>(folder.put("b", gzipped(content))), kSamples);
    }
  }
  OpenOptions raw;
  raw.raw = parse_raw_layout("3x2x5:int16:skip=2");
  EXPECT_EQ(read_file<std::int16_t>(folder.put("b", gzipped("xx" + stored(kSamples))), raw), kSamples);
}

// More than what is kept of a packed file's beginning.
TEST(Packed, ReadsLongFilesInTheirOrder) {
  const TempFolder folder;
  const std::vector<std::int16_t> samples = noise(256 * 256 * 20);
  const std::string content = nrrd_file(stored(samples), "256 256 20");
  const std::string path = folder.put("a.nrrd.gz", gzipped(content));
  EXPECT_EQ(read_file<std::int16_t>(path), samples);
  const auto source = open_volume(path);
  EXPECT_FALSE(source->skips());
  std::vector<std::int16_t> slice(256 * 256);
  source->read(17, 1, std::as_writable_bytes(std::span(slice)));
  EXPECT_TRUE(std::equal(slice.begin(), slice.end(), samples.begin() + 17 * 256 * 256));
  const std::string raw = folder.put("a_256x256x20_int16.raw.gz", gzipped(stored(samples)));
  EXPECT_EQ(read_file<std::int16_t>(raw), samples);
}

TEST(Packed, FindsDamageAndWrongSizesOfLongFiles) {
  const TempFolder folder;
  const std::vector<std::int16_t> samples = noise(256 * 256 * 20);
  std::string packed = gzipped(nrrd_file(stored(samples), "256 256 20"));
  const auto refused = [&](const std::string& name, const std::string& content, const std::string& why) {
    const std::string message = refusal(folder.put(name, content));
    EXPECT_TRUE(contains(message, why)) << message;
  };
  refused("a", packed.substr(0, packed.size() - 9), "its end missing");
  refused("a", gzipped(nrrd_file(stored(samples), "256 256 21")), "bytes of samples, found");
  refused("a", gzipped(nrrd_file(stored(samples), "256 256 2000000")), "once inflated");
  refused("a_256x256x21_int16.raw.gz", gzipped(stored(samples)), "by its layout, found 2621440");
  packed[packed.size() - 6] ^= 1;  // its sum
  refused("a", packed, "corrupt");
  // What follows the samples is read for the sake of the sum behind it.
  const std::string header = mgh_header({.numbers = {1, 256, 256, 20, 1, 4, 0}});
  packed = gzipped(header + stored(samples, true) + std::string(40, 't'));
  EXPECT_EQ(read_file<std::int16_t>(folder.put("a.mgz", packed)), samples);
  packed[packed.size() - 6] ^= 1;
  refused("a.mgz", packed, "corrupt");
}

TEST(Packed, ReadsAnywhereByBeginningAgain) {
  const TempFolder folder;
  const std::string content = stored(noise(1'500'000));
  const PackedFile file(open_file(folder.put("a.gz", gzipped(content))));
  EXPECT_FALSE(file.jumps());
  EXPECT_GE(file.size(), content.size());
  for (const std::size_t at : {2'000'000U, 5U, 1'100'000U, 2'999'990U, 1'048'570U}) {
    std::string part(100, '\0');
    part.resize(file.read_at(at, std::as_writable_bytes(std::span(part))));
    EXPECT_EQ(part, content.substr(at, 100)) << at;
  }
  EXPECT_EQ(file.exact_size(), content.size());
  EXPECT_EQ(file.size(), content.size());
  EXPECT_EQ(PackedFile(open_file(folder.put("b.gz", gzipped("short")))).size(), 5u);
  EXPECT_TRUE(contains(refusal(folder.put("e.gz", gzipped(""))), "an empty file in gzip"));
}

// Samples without a header that begin as gzip does are samples if they are as many as the layout says.
TEST(Packed, LeavesSamplesThatLookLikeGzip) {
  const TempFolder folder;
  const std::string bytes = "\x1f\x8b" + std::string(22, '\b');
  EXPECT_EQ(stored(read_file<std::uint8_t>(folder.put("a_4x3x2_uint8.raw", bytes))), bytes);
  OpenOptions raw;
  raw.raw = parse_raw_layout("4x3x2:uint8");
  EXPECT_EQ(stored(read_file<std::uint8_t>(folder.put("a", bytes), raw)), bytes);
}

TEST(Packed, RefusesDicomInGzip) {
  const TempFolder folder;
  EXPECT_TRUE(contains(refusal(folder.put("a.dcm.gz", gzipped(std::string(128, '\0') + "DICM" + std::string(99, 'x')))),
                       "DICOM in a pipe or in gzip"));
}

// A pipe in the folder, into which a thread writes.
class Pipe {
 public:
  Pipe(const TempFolder& folder, std::string content) : path_(folder / "pipe"), content_(std::move(content)) {
    std::filesystem::remove(path_);
    EXPECT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    writer_ = std::thread([this] { std::ofstream(path_, std::ios::binary) << content_; });
  }
  ~Pipe() { writer_.join(); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::string content_;
  std::thread writer_;
};

TEST(Pipes, GiveEveryFormat) {
  const TempFolder folder;
  for (const auto& [name, content] : all_files()) {
    for (const bool packed : {false, true}) {
      const Pipe pipe(folder, packed ? gzipped(content) : content);
      OpenOptions options;
      if (contains(name, "raw")) options.raw = parse_raw_layout("3x2x5:int16");
      EXPECT_EQ(read_file<std::int16_t>(pipe.path(), options), kSamples) << name << packed;
    }
  }
}

// A run reads its volume several times.
TEST(Pipes, MayBeOpenedAgainWhileTheyAreHeld) {
  const TempFolder folder;
  const Pipe pipe(folder, nrrd_file(stored(kSamples)));
  const auto first = open_volume(pipe.path());
  const auto second = open_volume(pipe.path());
  EXPECT_EQ(samples_of<std::int16_t>(*second), kSamples);
  EXPECT_EQ(samples_of<std::int16_t>(*first), kSamples);
}

TEST(Pipes, AreRefusedWithoutContentOrWithOtherContent) {
  const TempFolder folder;
  EXPECT_TRUE(contains(refusal(Pipe(folder, "").path()), "nothing before the end of the pipe"));
  EXPECT_TRUE(contains(refusal(Pipe(folder, "words").path()), "found text"));
  EXPECT_TRUE(contains(refusal(Pipe(folder, nrrd_file("short")).path()), "60 bytes of samples"));
}

TEST(Unread, AreToldWithTheWayRound) {
  const TempFolder folder;
  const std::string tar = std::string(257, 'a') + "ustar" + std::string(200, '\0');
  const std::string zip = "PK\x03\x04" + std::string(22, '\0');
  const auto zip_of = [&](const std::string& name) {
    return zip + std::string(1, static_cast<char>(name.size())) + std::string(3, '\0') + name + "content";
  };
  const std::vector<std::pair<std::string, std::string>> files{
      {"CDF\1", "classic netCDF, as MINC 1 is: nccopy -k nc4, and mincconvert -2 for MINC 1, write what is read"},
      {std::string(" BDV\0\0\0\0", 8), "OpenVDB"},
      {"# HyperMesh BINARY\n", "HyperMesh"},
      {"ncaa\nrank=3;\n", "VFF: --raw"},
      {"\xff\xd8\xff\xe0", "a JPEG image: slices are read in PNG or TIFF"},
      {"GIF89a", "GIF"},
      {std::string("\0\0\0\x0cjP  \r\n", 10), "JPEG 2000"},
      {"BM1234", "BMP"},
      {"ZISRAWFILE", "CZI"},
      {std::string("\x70\0\0\0\x10\0\0\0*", 9), "Leica LIF"},
      {"\xda\xce\xbe\x0a", "Nikon ND2"},
      {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "OIB"},
      {"7z\xbc\xaf\x27\x1c", "7z archive: unpack"},
      {std::string("\xfd\x37zXZ\0", 6), "packed by xz: xz -dc FILE | isoweave"},
      {"BZh91AY", "bzip2 -dc"},
      {gzipped(gzipped("twice")), "gzip twice"},
      {"\x28\xb5\x2f\xfd", "zstd -dc"},
      {tar, "a tar archive"},
      {zip_of("image.zarr/.zgroup"), "Zarr in a zip archive"},
      {zip_of("[Content_Types].xml"), "simplify"},
      {zip_of("read.me"), "a zip archive: unpack"},
      {"# === DATA DESCRIPTION FILE ===\n", "PAR"},
      {"##TITLE=Parameter List\n", "Bruker"},
      {"\ntype  = string-attribute\n", "3dAFNItoNIFTI"},
      {"mrtrix image\ndim: 3,2,5\n", "mrconvert"},
      {"!INTERFILE :=\n", "Interfile"},
      {"MATLAB 5.0 MAT-file", "-v7.3"},
      {"%PDF-1.4", "PDF"},
      {"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"},
      {"<!DOCTYPE html>", "a web page"},
      {"ply\nformat ascii 1.0\n", "a mesh in PLY: isoweave simplify"},
      {"solid thing\n", "simplify"},
      {std::string("glTF\2\0\0\0", 8), "simplify"},
      {"OFF\n3 1 0\n", "simplify"},
      {"# HyperSurface 0.1 ASCII\n", "PLY or STL"},
      {"\xff\xff\xfe"
       "created by",
       "mris_convert"},
      {"some words\n", "found text"},
      {std::string("\1\2\3\4", 4), "found other content"}};
  for (const auto& [content, what] : files) {
    for (const std::string& path : {folder.put("a.dat", content), folder.put("a.dat.gz", gzipped(content))}) {
      const std::string message = refusal(path);
      EXPECT_TRUE(contains(message, what)) << message;
    }
  }
  EXPECT_TRUE(contains(refusal(folder.put("a.stl", std::string(100, '\0'))), "simplify"));
  EXPECT_TRUE(contains(refusal(folder.put("a.obj", "v 1 2 3\n")), "simplify"));
  EXPECT_TRUE(contains(refusal(folder.put("a.npy", "CDF\1")), "the magic of NPY, found classic netCDF"));
}

}  // namespace
}  // namespace isoweave::testing::volume_packed_test
