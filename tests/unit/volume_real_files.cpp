// Files as other programs wrote them. They are not part of the project: without the folder these tests skip.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "volume/samples.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing {
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
  EXPECT_TRUE(contains(open_volume(data_file("niftizarr_example4d/example4d.nii.gz"))->info().notes.at(0), "4-D"));
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
  EXPECT_TRUE(contains(refusal(data_file(folder + "_bz2.nrrd")), "encoding 'bzip2' is not supported"));
  EXPECT_TRUE(contains(refusal(data_file(folder + "_byteskip_minus_five.nhdr")), "54000"));
  EXPECT_EQ(read_file<std::int16_t>(data_file(folder + ".nii.gz")), expected);
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
  EXPECT_TRUE(contains(refusal(data_file(folder + "warning/image-01.zarr")), "found '<i8'"));
}
#endif

TEST_F(RealFiles, PvmInDds) { expect_as_described("dti_b0_pvm", "DTI-B0.pvm"); }

}  // namespace
}  // namespace isoweave::testing
