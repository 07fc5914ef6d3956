// Small files of all formats, cut off within their headers: each is refused in one line that says what was expected and
// what was found, or is read where its format allows. The files are those that the fuzzer begins with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <regex>
#include <span>
#include <string>
#include <vector>

#include "fuzz/input_files.hpp"
#include "fuzz/seeds.hpp"
#include "isoweave/error.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/volume.hpp"
#include "unit/volume_helpers.hpp"

namespace isoweave {
namespace {

struct Kind {
  const char* target;  // of the fuzzer
  const char* names;   // of the files that one of its inputs holds
  bool is_mesh = false;
};

constexpr Kind kKinds[] = {
    {"nrrd", "a.nhdr:a1.raw:a2.raw"},
    {"metaimage", "a.mhd:a1.raw:a2.raw"},
    {"nifti", "a.nii"},
    {"nifti_pair", "a.hdr:a.img"},
    {"analyze", "a.hdr:a.img"},
    {"mgh", "a.mgh"},
    {"mrc", "a.rec"},
    {"npy", "a.npy"},
    {"npz", "a.npz"},
    {"amira", "a.am"},
    {"fits", "a.fits"},
    {"slc", "a.slc"},
    {"gzip", "a.gz"},
    {"pvm", "a.pvm"},
    {"tiff", "a.tif"},
    {"png", "a.png"},
    {"dicom", "a.dcm"},
    {"vti", "a.vti"},
    {"vtr", "a.vtr"},
    {"vtk", "a.vtk"},
    {"zarr2", "/:.zarray:.zattrs:0.0.0:0.0.1:0/0/0:0/0/1"},
    {"zarr3", "/:zarr.json:c/0/0/0:c/0/0/1:c/1/0/0:c.0.0.0:0.0.0"},
    {"n5", "/:attributes.json:0/0/0:1/0/0:s0/attributes.json:s0/0/0/0:s1/attributes.json"},
    {"precomputed", "/:info:k/0-2_0-3_0-2:k/2-4_0-3_0-2:k/0.shard:k/1.shard"},
    {"ply", "a.ply", true},
    {"stl", "a.stl", true},
    {"obj", "a.obj", true},
    {"off", "a.off", true},
    {"vtp", "a.vtp", true},
    {"vtu", "a.vtu", true},
    {"pvtp", "a.pvtp:a_0.vtp:a_1.vtu", true},
    {"vtk_mesh", "a.vtk", true},
    {"glb", "a.glb", true},
    {"gltf", "a.gltf:a.bin", true},
    {"3mf", "a.3mf", true},
    {"mesh_gzip", "a.gz", true},
};

void read_all(const std::string& path, bool is_mesh) {
  constexpr std::size_t kReadable = std::size_t{1} << 16;
  if (is_mesh) {
    read_mesh(path);
    return;
  }
  const auto volume = open_volume(path);
  const auto slices = static_cast<std::size_t>(volume->info().dims[2]);
  if (volume->info().slice_bytes() > kReadable / slices) return;
  std::vector<std::byte> samples(volume->info().slice_bytes() * slices);
  volume->read(0, volume->info().dims[2], samples);
}

std::string without(std::string text, const std::string& part) {
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part)) text.erase(at, part.size());
  return text;
}

// The message that refuses a file, without the folder; empty where the file is read.
std::string refusal(const fuzz::InputFiles& files, bool is_mesh) {
  const std::string folder = std::filesystem::path(files.path()).parent_path().string();
  try {
    read_all(files.path(), is_mesh);
    return "";
  } catch (const BadInput& error) {
    return without(error.what(), folder + "/");
  } catch (const std::exception& error) {
    return std::string("another exception: ") + error.what();
  }
}

// Messages that say nothing: nothing that was expected, or a number that stands for bytes that are not there.
bool says_something(const std::string& message) {
  static const std::regex kLine("[^:\n]+: ([^\n]*expected [^\n]+, found [^\n]+|[^\n]+ refers to [^\n]+)");
  static const std::regex kNonsense("expected[^,]* 0 bytes|expected[^,]*-[0-9]|[0-9]{8}|found -");
  return std::regex_match(message, kLine) && !std::regex_search(message, kNonsense);
}

class CutFiles : public ::testing::TestWithParam<Kind> {
 protected:
  static void SetUpTestSuite() {
    seeds_ = new testing::TempFolder;
    fuzz::Seeds seeds(*seeds_ / "");
    fuzz::put_files(seeds);
  }
  static void TearDownTestSuite() { delete seeds_; }

  // The files of an input of a target; nothing for one that is not there.
  static std::string input(const std::string& target, int number) {
    return testing::get(*seeds_ / (target + "/" + std::to_string(number)));
  }

  static testing::TempFolder* seeds_;
};

testing::TempFolder* CutFiles::seeds_ = nullptr;

void put(fuzz::InputFiles& files, const std::string& content) {
  files.put({reinterpret_cast<const std::uint8_t*>(content.data()), content.size()});
}

TEST_P(CutFiles, AreRefusedInWords) {
  constexpr std::size_t kHeader = 600;
  constexpr int kInputs = 4;
  const Kind kind = GetParam();
  if (input(kind.target, 0).empty()) GTEST_SKIP() << "built without " << kind.target;
  fuzz::InputFiles files(kind.names);
  for (int number = 0; number < kInputs; ++number) {
    const std::string whole = input(kind.target, number);
    const std::size_t end = std::min(whole.find(fuzz::kNextFile), whole.size());
    for (std::size_t cut = 0; cut < std::min(kHeader, end); ++cut) {
      put(files, whole.substr(0, cut) + whole.substr(end));
      const std::string message = refusal(files, kind.is_mesh);
      EXPECT_TRUE(message.empty() || says_something(message))
          << kind.target << " " << number << " cut at " << cut << ": " << message;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, CutFiles, ::testing::ValuesIn(kKinds),
                         [](const auto& test) { return std::string(test.param.target); });

struct Cut {
  const char *name, *content, *message;
};

// Where a field or a value is missing, it is named.
TEST(CutHeaders, NameWhatIsMissing) {
  const Cut cuts[] = {
      {"a.npy",
       "\x93"
       "NUMPY",
       "expected the version of NPY at byte 6, found a file of 6 bytes"},
      {"a.npy",
       "\x93"
       "NUMPY\1\1v",
       "expected the length of an NPY header at byte 8, found a file of 9 bytes"},
      {"a.npy",
       "\x93"
       "NUMPY\1\1v\1"
       "{'descr'",
       "expected a header of 374 bytes from byte 10 on, found a file of 18 bytes"},
      {"a.nrrd", "NRRD0004\ndimension: 3\n", "expected the field 'type', found none"},
      {"a.nrrd", "NRRD0004\ntype: short\n", "expected the field 'dimension', found none"},
      {"a.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 1 2 3\n", "expected the field 'encoding', found none"},
      {"a.mhd", "NDims = 3\nDimSize = 1 2 3\nElementType = MET_SHORT\nElementDataFile = ",
       "expected LOCAL, LIST or a file behind ElementDataFile, found nothing"},
      {"a.ply", "pl", "expected the line 'ply' at the beginning, found 'pl'"},
      {"a.ply", "ply\nformat asc",
       "header line 2: expected ascii, binary_little_endian or binary_big_endian, found "
       "'format asc'"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex",
       "header line 3: expected 'element NAME COUNT', found 'element vertex'"},
  };
  for (const Cut& cut : cuts) {
    fuzz::InputFiles files(cut.name);
    put(files, cut.content);
    EXPECT_EQ(refusal(files, std::string(cut.name) == "a.ply"), std::string(cut.name) + ": " + cut.message);
  }
}

}  // namespace
}  // namespace isoweave
