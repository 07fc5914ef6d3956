// Files as other programs wrote them. They are not part of the project: without the folder these tests skip.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "volume/samples.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing::volume_real_files_test {
namespace {

const std::filesystem::path kData = ISOWEAVE_DATA_DIR;

class RealFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kData.empty() || !std::filesystem::is_directory(kData)) GTEST_SKIP() << "ISOWEAVE_DATA_DIR is not set";
  }
};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

template <class Sample>
Range range_of(SliceSource& source) {
  Range range;
  for (const Sample sample : samples_of<Sample>(source, 5)) {
    range.low = std::min(range.low, static_cast<double>(sample));
    range.high = std::max(range.high, static_cast<double>(sample));
  }
  return range;
}

Range range_of(SliceSource& source) {
  switch (source.info().type) {
    case SampleType::kUint8:
      return range_of<std::uint8_t>(source);
    case SampleType::kInt8:
      return range_of<std::int8_t>(source);
    case SampleType::kUint16:
      return range_of<std::uint16_t>(source);
    case SampleType::kInt16:
      return range_of<std::int16_t>(source);
    case SampleType::kUint32:
      return range_of<std::uint32_t>(source);
    case SampleType::kInt32:
      return range_of<std::int32_t>(source);
    case SampleType::kUint64:
      return range_of<std::uint64_t>(source);
    case SampleType::kInt64:
      return range_of<std::int64_t>(source);
    case SampleType::kFloat32:
      return range_of<float>(source);
    case SampleType::kFloat64:
      return range_of<double>(source);
  }
  return {};
}

std::string data_file(const std::string& name) { return (kData / name).string(); }

// Compares dims, spacing, and the range of the samples with the folder's description.
void expect_as_described(const std::string& folder, const std::string& name) {
  const auto facts = nlohmann::json::parse(get(data_file(folder + "/info.json")));
  const auto source = open_volume(data_file(folder + "/" + name));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(source->info().dims[axis], facts["dims"][axis].get<std::int64_t>()) << name;
    EXPECT_NEAR(source->info().geometry.spacing[axis], facts["spacing"][axis].get<double>(), 1e-5) << name;
  }
  const Range range = range_of(*source);
  EXPECT_FLOAT_EQ(static_cast<float>(range.low), facts["min"].get<float>()) << name;
  EXPECT_FLOAT_EQ(static_cast<float>(range.high), facts["max"].get<float>()) << name;
}

TEST_F(RealFiles, NiftiGzip) {
  expect_as_described("bonsai_256", "bonsai.nii.gz");
  expect_as_described("engine_256x256x128", "engine.nii.gz");
  expect_as_described("fnndsc_avf_nrrd", "avf_float_32.nii.gz");
}

TEST_F(RealFiles, NiftiOfSeveralVolumes) {
  expect_as_described("niftizarr_example4d", "example4d.nii.gz");
  EXPECT_TRUE(contains(open_volume(data_file("niftizarr_example4d/example4d.nii.gz"))->info().notes.at(0),
                       "the first of 2 along time"));
  EXPECT_EQ(open_volume(data_file("niftizarr_example4d/example_nifti2.nii.gz"))->info().format, "nifti");
}

TEST_F(RealFiles, NrrdGzip) {
  expect_as_described("fnndsc_avf_nrrd", "avf_float_32.nrrd");
  expect_as_described("fnndsc_fetal_t2_nrrd", "template_T2.nrrd");
  expect_as_described("seg3d_brain_labels_nrrd", "Brain.nrrd");
}

TEST_F(RealFiles, NrrdAndNiftiOfOneFieldLieInTheSamePlace) {
  const auto nrrd = open_volume(data_file("fnndsc_avf_nrrd/avf_float_32.nrrd"));
  const auto nifti = open_volume(data_file("fnndsc_avf_nrrd/avf_float_32.nii.gz"));
  EXPECT_EQ(read_all(*nrrd, 3), read_all(*nifti, 7));
  const Geometry& lps = nrrd->info().geometry;
  const Geometry& ras = nifti->info().geometry;
  EXPECT_EQ(lps.space, Space::kLps);
  EXPECT_EQ(ras.space, Space::kRas);
  for (std::size_t row = 0; row < 3; ++row) {
    const double sign = row < 2 ? -1 : 1;
    EXPECT_NEAR(lps.origin[row], sign * ras.origin[row], 1e-4) << row;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(lps.direction[3 * row + axis], sign * ras.direction[3 * row + axis], 1e-5) << row << axis;
    }
  }
}

TEST_F(RealFiles, NrrdDetachedBigEndian) { expect_as_described("tooth_nhdr", "tooth.nhdr"); }

TEST_F(RealFiles, NrrdVariantsOfOneBall) {
  const std::string folder = "pynrrd_variants_synthetic/BallBinary30x30x30";
  const auto expected = read_file<std::int16_t>(data_file(folder + ".nrrd"));
  EXPECT_EQ(*std::min_element(expected.begin(), expected.end()), 0);
  for (const char* variant : {".nhdr", "_byteskip_minus_one.nhdr", "_byteskip_minus_one_nifti.nhdr", "_gz.nrrd",
                              "_gz_byteskip_minus_one.nrrd", "_gz_lineskip.nrrd"}) {
    EXPECT_EQ(read_file<std::int16_t>(data_file(folder + variant)), expected) << variant;
  }
  EXPECT_TRUE(
      contains(refusal(data_file(folder + "_bz2.nrrd")), "expected encoding raw, gzip, ascii or hex, found 'bzip2'"));
  EXPECT_TRUE(contains(refusal(data_file(folder + "_byteskip_minus_five.nhdr")), "54000"));
  EXPECT_EQ(read_file<std::int16_t>(data_file(folder + ".nii.gz")), expected);
}

// Each of them counts from 1 to 27.
TEST_F(RealFiles, NrrdInText) {
  std::vector<int> expected(27);
  std::iota(expected.begin(), expected.end(), 1);
  const auto numbers = [](const auto& samples) { return std::vector<int>(samples.begin(), samples.end()); };
  const std::string folder = "pynrrd_variants_synthetic/";
  EXPECT_EQ(numbers(read_file<std::uint8_t>(data_file(folder + "test1d_ascii.nrrd"))), expected);
  EXPECT_EQ(numbers(read_file<std::uint16_t>(data_file(folder + "test2d_ascii.nrrd"))), expected);
  EXPECT_EQ(numbers(read_file<std::uint8_t>(data_file(folder + "test_customFields.nrrd"))), expected);
  EXPECT_EQ(open_volume(data_file("pynrrd_variants_synthetic/test_simple4d_raw.nrrd"))->info().type,
            SampleType::kFloat64);
}

// One headerless file per slice, without a name that says so.
TEST_F(RealFiles, HeaderlessSlicesNeedALayout) {
  const std::string slices = "vtk_headsq_quarter/quarter.";
  EXPECT_TRUE(contains(refusal(data_file(slices + "*")), "expected a slice in TIFF, PNG or DICOM"));
  OpenOptions options;
  options.raw = RawLayout{{64, 64, 93}, SampleType::kUint16, false, 0};
  const auto all = samples_of<std::uint16_t>(*open_volume(data_file(slices + "[1-9]*"), options));
  EXPECT_EQ(all.size(), 64u * 64 * 93);
  options.raw->dims[2] = 1;
  const auto tenth = samples_of<std::uint16_t>(*open_volume(data_file(slices + "10"), options));
  EXPECT_TRUE(std::equal(tenth.begin(), tenth.end(), all.begin() + 9 * 64 * 64));
  std::int64_t sum = 0;
  for (int n = 1; n <= 93; ++n) {
    const std::string path = data_file(slices + std::to_string(n));
    options.raw->skip_bytes = static_cast<std::int64_t>(std::filesystem::file_size(path)) - 2 * 64 * 64;
    for (const std::uint16_t sample : read_file<std::uint16_t>(path, options)) sum += sample;
  }
  const auto facts = nlohmann::json::parse(get(data_file("vtk_headsq_quarter/info.json")));
  EXPECT_EQ(sum, std::llround(facts["mean"].get<double>() * facts["voxels"].get<double>()));
}

TEST_F(RealFiles, MetaImageZlib) { expect_as_described("elastix_ct_lung_mha", "3DCT_lung.mha"); }

double sum_of(const std::string& path) {
  const auto source = open_volume(path);
  double sum = 0;
  visit_sample_type(source->info().type, [&]<class Sample>() {
    for (const Sample sample : samples_of<Sample>(*source, 5)) sum += static_cast<double>(sample);
  });
  return sum;
}

// Beside the range, the sum: of integers below 2^53 it is exact.
void expect_described_sum(const std::string& folder, const std::string& name) {
  expect_as_described(folder, name);
  const auto facts = nlohmann::json::parse(get(data_file(folder + "/info.json")));
  const double sum = facts["mean"].get<double>() * facts["voxels"].get<double>();
  EXPECT_NEAR(sum_of(data_file(folder + "/" + name)), sum, 1e-6 + 1e-9 * std::abs(sum)) << name;
}

#ifdef ISOWEAVE_HAS_TIFF
TEST_F(RealFiles, TiffOfImageJ) {
  expect_described_sum("neubias_mri_head_tif", "xyz_8bit_calibrated_anisotropic__mri_head.tif");
  expect_described_sum("neubias_chromosomes_tif", "xyz_8bit__chromosomes.tif");
  EXPECT_EQ(open_volume(data_file("neubias_chromosomes_tif/xyz_8bit__chromosomes.tif"))->info().geometry.unit, "um");
}

TEST_F(RealFiles, TiffSeries) {
  expect_described_sum("neubias_celegans_em_tifs", "");
  expect_described_sum("neubias_celegans_em_tifs", "*.tif");
}
#endif

// Ranges and means in the descriptions are of the samples as stored.
TEST_F(RealFiles, DicomSeries) {
  expect_described_sum("fnndsc_abdomen", "");
  expect_described_sum("seg3d_mr_dicom", "");
  const VolumeInfo ct = open_volume(data_file("fnndsc_abdomen"))->info();
  EXPECT_EQ(ct.slope, 1);
  EXPECT_EQ(ct.intercept, -1000);
  EXPECT_NEAR(ct.geometry.origin[2], -679.8, 1e-3);
}

TEST_F(RealFiles, VtiAppendedAndInline) {
  expect_described_sum("ttk_isabel_vti", "isabel_30.vti");
  expect_described_sum("vtk_hydrogen_vti", "hydrogen.vti");
}

// What other people's programs make of a file: size, the CRC-32 of all samples (little-endian), and the matrix from
// samples to the file's own world.
struct Independent {
  std::string name;
  std::array<std::int64_t, 3> dims;
  std::uint32_t crc;
  std::array<double, 12> affine;
};

void expect_as_read_by(const Independent& expected) {
  SCOPED_TRACE(expected.name);
  const auto source = open_volume(data_file(expected.name));
  const VolumeInfo& info = source->info();
  ASSERT_EQ(info.dims, expected.dims);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const double found =
          axis == 3 ? info.geometry.origin[row] : info.geometry.direction[3 * row + axis] * info.geometry.spacing[axis];
      // The numbers below have nine digits.
      const double number = expected.affine[4 * row + axis];
      EXPECT_NEAR(found, number, 1e-6 * std::max(1.0, std::abs(number))) << row << axis;
    }
  }
  std::vector<std::byte> slice(info.slice_bytes());
  uLong crc = crc32(0, nullptr, 0);
  for (std::int64_t k = 0; k < info.dims[2]; ++k) {
    source->read(k, 1, slice);
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(slice.data()), slice.size());
  }
  EXPECT_EQ(crc, expected.crc);
}

// By nibabel (NIfTI), teem (NRRD), VTK (VTI, MetaImage) and pydicom.
TEST_F(RealFiles, EverySampleAndPlaceIsThatOfIndependentReaders) {
  for (const Independent& expected : std::vector<Independent>{
           {"bonsai_256/bonsai.nii.gz", {256, 256, 256}, 0xf5fd13a7, {1, 0, 0, -127, 0, 1, 0, -127, 0, 0, 1, -128}},
           {"engine_256x256x128/engine.nii.gz",
            {256, 256, 128},
            0x5db1123a,
            {1, 0, 0, -127, 0, 1, 0, -127, 0, 0, 1, -64}},
           {"fnndsc_avf_nrrd/avf_float_32.nii.gz",
            {74, 93, 20},
            0x817784e5,
            {0.722656012, 0, -0, -26.3769436, 0, 0.722656012, -0, -33.2421761, 0, 0, 1, -9.5}},
           {"niftizarr_example4d/example4d.nii.gz",
            {128, 96, 24},
            0x1fc30152,
            {-2, 6.71471565e-19, 9.08102451e-18, 117.855103, -6.71471565e-19, 1.97371149, -0.355528235, -35.7229424,
             8.25548089e-18, 0.323207617, 2.17108178, -7.24879837}},
           {"niftizarr_example4d/example_nifti2.nii.gz",
            {32, 20, 12},
            0x10b09929,
            {-2, 6.71471565e-19, 9.08102451e-18, 117.855103, -6.71471565e-19, 1.97371149, -0.355528235, -35.7229424,
             8.25548089e-18, 0.323207617, 2.17108178, -7.24879837}},
           {"pynrrd_variants_synthetic/BallBinary30x30x30.nii.gz",
            {30, 30, 30},
            0xe4bde59d,
            {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0}},
           {"fnndsc_avf_nrrd/avf_float_32.nrrd",
            {74, 93, 20},
            0x817784e5,
            {-0.722656012, 0, 0, 26.3769444, 0, -0.722656012, 0, 33.2421765, 0, 0, 1, -9.5}},
           {"fnndsc_fetal_t2_nrrd/template_T2.nrrd",
            {117, 159, 126},
            0x6e5b8fb4,
            {0.859375, 0, 0, -49.84375, 0, 0.859375, 0, 67.890625, 0, 0, 0.859375, -53.7109375}},
           {"seg3d_brain_labels_nrrd/Brain.nrrd",
            {160, 232, 160},
            0xf4ddbfa9,
            {1, 0, 0, 229.26, 0, 0.898437, 0, -126.419, 0, 0, 0.898437, 405.421}},
           {"seg3d_brain_labels_nrrd/Skull.nrrd",
            {160, 232, 160},
            0x73b040f3,
            {1, 0, 0, 229.26, 0, 0.898437, 0, -126.419, 0, 0, 0.898437, 405.421}},
           {"seg3d_brain_labels_nrrd/BrainSkull.nrrd",
            {160, 232, 160},
            0x4bb0934f,
            {1, 0, 0, 229.26, 0, 0.898437, 0, -126.419, 0, 0, 0.898437, 403.624}},
           {"tooth_nhdr/tooth.nhdr", {103, 94, 161}, 0x9411034e, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
           {"pynrrd_variants_synthetic/BallBinary30x30x30.nrrd",
            {30, 30, 30},
            0xe4bde59d,
            {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
           {"pynrrd_variants_synthetic/BallBinary30x30x30_nifti.nhdr",
            {30, 30, 30},
            0x0b39b809,
            {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
           {"ttk_isabel_vti/isabel_30.vti",
            {125, 125, 25},
            0x64babd06,
            {4.00803213, 0, 0, 0, 0, 4.00803213, 0, 0, 0, 0, 4.04081633, 0}},
           {"vtk_hydrogen_vti/hydrogen.vti", {64, 64, 64}, 0x30bd7117, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}},
           {"elastix_ct_lung_mha/3DCT_lung.mha",
            {115, 157, 129},
            0x3ddcf5f4,
            {1.366, 0, 0, -153.827, 0, 1.366, 0, -150.352, 0, 0, 2.5, -1434.5}},
           {"elastix_ct_lung_mha/3DCT_lung_baseline_small.mha",
            {57, 78, 64},
            0x1ab9c7dc,
            {2.732, 0, 0, -152.461, 0, 2.732, 0, -148.986, 0, 0, 5, -1432}},
           {"fnndsc_abdomen",
            {512, 512, 275},
            0xece97cd4,
            {0.78125, 0, 0, -201, 0, 0.78125, 0, -59, 0, 0, 1, -679.800049}},
           {"seg3d_mr_dicom",
            {640, 640, 44},
            0x44bc110d,
            {0.625, 1.28189625e-10, 0, -156.416466, -1.28189625e-10, 0.625, 0, -200, 0, 0, 2.5, -17.1204605}}}) {
    expect_as_read_by(expected);
  }
}

#ifdef ISOWEAVE_HAS_TIFF
// By tifffile.
TEST_F(RealFiles, EverySampleAndPlaceOfTiffIsThatOfAnIndependentReader) {
  for (const Independent& expected : std::vector<Independent>{
           {"neubias_mri_head_tif/xyz_8bit_calibrated_anisotropic__mri_head.tif",
            {186, 226, 27},
            0xf2060b39,
            {0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 7, 0}},
           {"neubias_chromosomes_tif/xyz_8bit__chromosomes.tif",
            {126, 152, 40},
            0x065c2096,
            {0.0338541684, 0, 0, 0, 0, 0.0338541684, 0, 0, 0, 0, 0.15, 0}},
           {"neubias_celegans_em_tifs", {256, 256, 21}, 0xad576f8f, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}}) {
    expect_as_read_by(expected);
  }
}
#endif

#ifdef ISOWEAVE_HAS_HDF5
TEST_F(RealFiles, Hdf5) {
  expect_described_sum("gala_em_h5", "train-image.h5");
  expect_described_sum("gala_membrane_prob_h5", "train-p1.lzf.h5");
}
#endif

#if defined(ISOWEAVE_HAS_ZARR) && defined(ISOWEAVE_HAS_BLOSC)
TEST_F(RealFiles, OmeZarr) {
  expect_described_sum("niftizarr_example4d", "example4d.nii.zarr");
  EXPECT_EQ(read_file<std::int16_t>(data_file("niftizarr_example4d/example4d.nii.zarr")),
            read_file<std::int16_t>(data_file("niftizarr_example4d/example4d.nii.gz")));
  OpenOptions second;
  second.time = 1;
  second.level = 1;
  const VolumeInfo info = open_volume(data_file("niftizarr_example4d/example4d.nii.zarr"), second)->info();
  EXPECT_NEAR(info.geometry.origin[2], 1.0999995, 1e-6);
  EXPECT_EQ(info.dims, (std::array<std::int64_t, 3>{64, 48, 12}));
}

TEST_F(RealFiles, OmeZarrExamples) {
  const std::string folder = "omezarr_examples_synthetic/";
  EXPECT_EQ(open_volume(data_file(folder + "valid/image-02.zarr"))->info().dims[1], 200);
  const auto stack = open_volume(data_file(folder + "valid/image-03.zarr"));
  EXPECT_EQ(stack->info().geometry.unit, "um");
  EXPECT_EQ(samples_of<double>(*stack).size(), 20000U);
  EXPECT_TRUE(contains(open_volume(data_file(folder + "valid/image-04.zarr"))->info().notes[0], "no chunk is stored"));
  EXPECT_TRUE(contains(refusal(data_file(folder + "valid/plate-01.zarr")), "--dataset with one of 'A/1/0', 'A/2/0'"));
  EXPECT_TRUE(contains(refusal(data_file(folder + "invalid/image-01.zarr")), "expected an image or array"));
  EXPECT_TRUE(contains(refusal(data_file(folder + "invalid/image-02.zarr")), "expected an image in 'multiscales'"));
  EXPECT_TRUE(contains(refusal(data_file(folder + "invalid/image-03.zarr")), "expected an array or group at '0'"));
  OpenOptions second;
  second.level = 1;
  EXPECT_TRUE(contains(refusal(data_file(folder + "invalid/image-04.zarr"), second), "3 axes of its image"));
  EXPECT_EQ(open_volume(data_file(folder + "warning/image-01.zarr"))->info().type, SampleType::kInt64);
}
#endif

TEST_F(RealFiles, PvmInDds) { expect_described_sum("dti_b0_pvm", "DTI-B0.pvm"); }

}  // namespace
}  // namespace isoweave::testing::volume_real_files_test
