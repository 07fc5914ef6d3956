// NIfTI-1 and NIfTI-2: a fixed binary header of either byte order, in the file of the samples (.nii, .nii.gz) or
// beside it (.hdr and .img).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "files/external_files.hpp"
#include "files/header_text.hpp"
#include "files/part_file.hpp"
#include "files/quoted.hpp"
#include "volume/axes.hpp"
#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/medical/type_codes.hpp"
#include "volume/formats/other/header_fields.hpp"
#include "volume/packed_file.hpp"
#include "volume/picked_stream.hpp"

namespace isoweave {
namespace {

constexpr std::int32_t kHeader1 = 348;
constexpr std::int32_t kHeader2 = 540;

constexpr std::array<TypeCode, 9> kNiftiAddedTypes{{{256, SampleType::kInt8},
                                                    {512, SampleType::kUint16},
                                                    {768, SampleType::kUint32},
                                                    {1024, SampleType::kInt64},
                                                    {1280, SampleType::kUint64},
                                                    {1536, std::nullopt, "float128"},
                                                    {1792, std::nullopt, "complex128"},
                                                    {2048, std::nullopt, "complex256"},
                                                    {2304, std::nullopt, "RGBA"}}};
constexpr TypeCodes kNiftiTypes{"NIfTI", "a scalar type of 8 to 64 bit integers or 32 or 64 bit floats",
                                kNiftiAddedTypes};

// The fields of both versions in one form.
struct NiftiHeader {
  int version = 1;
  bool swapped = false;
  bool single_file = true;
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  double data_offset = 0;
  double slope = 0;
  double intercept = 0;
  std::int64_t type = 0;
  std::int64_t bits = 0;
  std::int64_t intent = 0;
  std::int64_t qform = 0;
  std::int64_t sform = 0;
  std::array<double, 6> quaternion{};  // b, c, d, then the offsets of x, y, z
  std::array<double, 12> rows{};       // srow_x, srow_y, srow_z
  std::int64_t units = 0;
};

NiftiHeader parse_version1(const HeaderFields& field) {
  NiftiHeader header;
  field.fill<std::int16_t>(header.dim, 40);
  header.intent = field.at<std::int16_t>(68);
  header.type = field.at<std::int16_t>(70);
  header.bits = field.at<std::int16_t>(72);
  field.fill<float>(header.pixdim, 76);
  header.data_offset = static_cast<double>(field.at<float>(108));
  header.slope = static_cast<double>(field.at<float>(112));
  header.intercept = static_cast<double>(field.at<float>(116));
  header.units = field.at<std::uint8_t>(123);
  header.qform = field.at<std::int16_t>(252);
  header.sform = field.at<std::int16_t>(254);
  field.fill<float>(header.quaternion, 256);
  field.fill<float>(header.rows, 280);
  return header;
}

NiftiHeader parse_version2(const HeaderFields& field) {
  NiftiHeader header;
  header.version = 2;
  header.type = field.at<std::int16_t>(12);
  header.bits = field.at<std::int16_t>(14);
  field.fill<std::int64_t>(header.dim, 16);
  field.fill<double>(header.pixdim, 104);
  header.data_offset = static_cast<double>(field.at<std::int64_t>(168));
  header.slope = field.at<double>(176);
  header.intercept = field.at<double>(184);
  header.qform = field.at<std::int32_t>(344);
  header.sform = field.at<std::int32_t>(348);
  field.fill<double>(header.quaternion, 352);
  field.fill<double>(header.rows, 400);
  header.units = field.at<std::int32_t>(500);
  header.intent = field.at<std::int32_t>(504);
  return header;
}

// The header, or nothing unless both the size field and the magic are those of NIfTI.
std::optional<NiftiHeader> parse_nifti(std::string_view bytes) {
  for (const bool swapped : {false, true}) {
    const HeaderFields field(bytes, swapped);
    if (bytes.size() >= kHeader1 && field.at<std::int32_t>(0) == kHeader1) {
      const std::string_view magic = bytes.substr(344, 4);
      if (magic != std::string_view("n+1\0", 4) && magic != std::string_view("ni1\0", 4)) return std::nullopt;
      NiftiHeader header = parse_version1(field);
      header.swapped = swapped;
      header.single_file = magic[1] == '+';
      return header;
    }
    if (bytes.size() >= kHeader2 && field.at<std::int32_t>(0) == kHeader2) {
      const std::string_view magic = bytes.substr(4, 4);
      if (magic != std::string_view("n+2\0", 4) && magic != std::string_view("ni2\0", 4)) return std::nullopt;
      NiftiHeader header = parse_version2(field);
      header.swapped = swapped;
      header.single_file = magic[1] == '+';
      return header;
    }
  }
  return std::nullopt;
}

// The axes from the slowest to the fastest: channels (dimensions 5 to 7 as one), time, z, y, x.
std::vector<ArrayAxis> axes_of(const NiftiHeader& header, std::string_view path) {
  const std::int64_t rank = header.dim[0];
  if (rank < 1 || rank > 7) bad_input(path, "1 to 7 dimensions", std::to_string(rank));
  std::vector<ArrayAxis> axes{{1, "channel"}, {1, "time"}, {1, "z"}, {1, "y"}, {1, "x"}};
  for (std::size_t n = 1; static_cast<std::int64_t>(n) <= rank; ++n) {
    ArrayAxis& axis = axes[n < axes.size() ? axes.size() - n : 0];
    // Beyond space a size of 0 stands for none.
    const std::int64_t size = n > 3 ? std::max<std::int64_t>(1, header.dim[n]) : header.dim[n];
    if (size < 1) bad_input(path, "dimensions of at least 1", std::to_string(size));
    if (__builtin_mul_overflow(axis.size, size, &axis.size)) {
      bad_input(path, "fewer than 2^63 volumes", "dimensions whose product is larger");
    }
  }
  return axes;
}

// Sample distances along the axes; files in use leave them zero or negative.
Vector3 grid_spacing(VolumeInfo& info, const NiftiHeader& header) {
  Vector3 spacing{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    spacing[axis] = std::abs(header.pixdim[axis + 1]);
    if (spacing[axis] == 0) {
      spacing[axis] = 1;
      info.notes.push_back("the spacing of axis " + std::to_string(axis) + " is 0 in the file and taken as 1");
    }
  }
  return spacing;
}

Axes axes_from_rows(const NiftiHeader& header) {
  Axes axes;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) axes.steps[axis][row] = header.rows[4 * row + axis];
    axes.origin[row] = header.rows[4 * row + 3];
  }
  return axes;
}

// The rotation of unit quaternion (a, b, c, d), where the file gives b, c, d and a is not negative.
Axes axes_from_quaternion(const NiftiHeader& header, const Vector3& spacing) {
  double b = header.quaternion[0];
  double c = header.quaternion[1];
  double d = header.quaternion[2];
  const double square = b * b + c * c + d * d;
  double a = 0;
  if (square < 1) {
    a = std::sqrt(1 - square);
  } else {
    // Rounding in the file: a half turn.
    const double length = std::sqrt(square);
    b /= length;
    c /= length;
    d /= length;
  }
  const double mirror = header.pixdim[0] < 0 ? -1 : 1;
  const std::array<Vector3, 3> columns{
      Vector3{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
      Vector3{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
      Vector3{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c}};
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scale = spacing[axis] * (axis == 2 ? mirror : 1);
    for (std::size_t row = 0; row < 3; ++row) axes.steps[axis][row] = columns[axis][row] * scale;
    axes.origin[axis] = header.quaternion[3 + axis];
  }
  return axes;
}

// The largest distance between where two sets of axes put a corner of the volume.
double apart(const Axes& a, const Axes& b, const std::array<std::int64_t, 3>& dims) {
  double largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vector3 between{};
    for (std::size_t row = 0; row < 3; ++row) {
      between[row] = a.origin[row] - b.origin[row];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool far = (corner >> axis & 1) != 0;
        if (far) between[row] += static_cast<double>(dims[axis] - 1) * (a.steps[axis][row] - b.steps[axis][row]);
      }
    }
    largest = std::max(largest, length_of(between));
  }
  return largest;
}

double shortest_step(const Axes& axes) {
  double shortest = HUGE_VAL;
  for (const Vector3& step : axes.steps) shortest = std::min(shortest, length_of(step));
  return shortest;
}

// Notes where the two forms of the axes differ by more than rounding. Both are kept as floats, and one as a rotation,
// so they differ by rounding.
void note_other_form(VolumeInfo& info, const NiftiHeader& header, const Axes& taken) {
  constexpr double kRounding = 1e-2;  // of a step between samples
  VolumeInfo ignored;
  const double distance = apart(taken, axes_from_quaternion(header, grid_spacing(ignored, header)), info.dims);
  if (distance <= kRounding * shortest_step(taken)) return;
  info.notes.push_back("sform and qform differ: the sform (code " + std::to_string(header.sform) +
                       ") is taken, the qform (code " + std::to_string(header.qform) + ") puts corners up to " +
                       rounded_text(distance) + " away");
}

// The rows give the steps, also where the field for the spacing says otherwise.
void note_other_spacing(VolumeInfo& info, const NiftiHeader& header) {
  constexpr double kRounding = 1e-3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double said = std::abs(header.pixdim[axis + 1]), taken = info.geometry.spacing[axis];
    if (said == 0 || info.dims[axis] == 1 || std::abs(said - taken) <= kRounding * taken) continue;
    info.notes.push_back("the spacing of axis " + std::to_string(axis) + " is " + rounded_text(taken) +
                         " by the sform, which is taken, and " + rounded_text(said) + " by pixdim");
  }
}

// The form that gives the axes, for messages.
std::string form_of(const NiftiHeader& header) {
  if (header.sform > 0) return " by the sform (code " + std::to_string(header.sform) + ")";
  if (header.qform > 0) return " by the qform (code " + std::to_string(header.qform) + ") and pixdim";
  return " by pixdim";
}

Axes axes_of_form(VolumeInfo& info, const NiftiHeader& header) {
  if (header.sform > 0) {
    const Axes axes = axes_from_rows(header);
    if (header.qform > 0) note_other_form(info, header, axes);
    return axes;
  }
  const Vector3 spacing = grid_spacing(info, header);
  if (header.qform > 0) return axes_from_quaternion(header, spacing);
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) axes.steps[axis][axis] = spacing[axis];
  info.geometry.space = Space::kUnknown;
  info.notes.push_back("the file gives no orientation (neither sform nor qform)");
  return axes;
}

void set_axes(VolumeInfo& info, const NiftiHeader& header) {
  info.geometry.space = Space::kRas;
  set_geometry(info.geometry, axes_of_form(info, header), info.path, form_of(header));
  if (header.sform > 0 && header.qform <= 0) note_other_spacing(info, header);
  constexpr std::array<std::string_view, 4> kUnits{"", "m", "mm", "um"};
  const auto unit = static_cast<std::size_t>(header.units & 7);
  if (unit < kUnits.size()) info.geometry.unit = kUnits[unit];
}

void set_scaling(VolumeInfo& info, const NiftiHeader& header) {
  if (header.slope == 0 || !std::isfinite(header.slope)) return;
  info.slope = header.slope;
  info.intercept = std::isfinite(header.intercept) ? header.intercept : 0;
}

// Notes what the header says of its samples besides their type.
void note_samples(VolumeInfo& info, const NiftiHeader& header, std::int64_t channels) {
  const auto bits = static_cast<std::int64_t>(8 * sample_bytes(info.type));
  if (header.bits != 0 && header.bits != bits) {
    info.notes.push_back("samples are " + std::string(sample_type_name(info.type)) +
                         " by the code of their type, which is taken, and of " + std::to_string(header.bits) +
                         " bits by bitpix");
  }
  // Matrices, displacements, vectors, points, quaternions.
  constexpr std::int64_t kFirstOfParts = 1004, kLastOfParts = 1010;
  if (channels > 1 && header.intent >= kFirstOfParts && header.intent <= kLastOfParts) {
    info.notes.push_back("samples are vectors or matrices (intent code " + std::to_string(header.intent) +
                         "), of which one component is read");
  }
}

VolumeInfo read_info(const NiftiHeader& header, const std::vector<ArrayAxis>& axes, const AxisChoice& choice,
                     const std::string& path) {
  VolumeInfo info;
  info.path = path;
  info.format = "nifti";
  info.type = type_of_code(header.type, kNiftiTypes, path);
  info.dims = choice.dims(axes);
  info.notes = choice.notes;
  info.part = choice.part;
  checked_volume_bytes(info);
  set_axes(info, header);
  set_scaling(info, header);
  note_samples(info, header, axes.front().size);
  return info;
}

std::uint64_t data_offset(const NiftiHeader& header, std::string_view path) {
  const std::uint64_t smallest = header.version == 1 ? 352 : 544;
  constexpr double kLargest = 4e18;
  const double offset = header.data_offset;
  if (header.single_file && offset == 0) return smallest;
  const double least = header.single_file ? static_cast<double>(smallest) : 0;
  if (!(offset >= least) || offset > kLargest) {
    bad_input(path, "samples from byte " + number_text(least) + " on", "an offset of " + number_text(offset));
  }
  return static_cast<std::uint64_t>(offset);
}

}  // namespace

FilePtr image_of_header(const std::string& header_path) {
  std::string stem = header_path;
  if (stem.ends_with(".gz")) stem.resize(stem.size() - 3);
  const bool capitals = stem.ends_with(".HDR");
  if (capitals || stem.ends_with(".hdr")) stem.resize(stem.size() - 4);
  const std::string plain = stem + (capitals ? ".IMG" : ".img");
  const std::string packed = plain + ".gz";
  std::error_code error;
  const bool only_packed = !std::filesystem::exists(plain, error) && std::filesystem::exists(packed, error);
  return unpacked(open_part(header_path, "its samples in", only_packed ? packed : plain));
}

bool is_nifti(std::string_view head) { return parse_nifti(head).has_value(); }

void refuse_other_magic(const std::string& path, std::string_view head) {
  std::string name = lower_case(path);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  if (!name.ends_with(".nii") || head.size() < kHeader1) return;
  for (const bool swapped : {false, true}) {
    const std::int32_t size = HeaderFields(head, swapped).at<std::int32_t>(0);
    if (size != kHeader1 && size != kHeader2) continue;
    const bool first = size == kHeader1;
    const std::string_view expected(first ? "n+1\0" : "n+2\0", 4), magic = head.substr(first ? 344 : 4, 4);
    if (magic == expected) continue;
    bad_input(path, "the magic " + in_quotes(expected.substr(0, 3)) + " of a NIfTI file with its samples",
              in_quotes(magic.ends_with('\0') ? magic.substr(0, 3) : magic));
  }
}

OpenedVolume open_nifti(const FilePtr& file, const OpenOptions& options) {
  const std::optional<NiftiHeader> header = parse_nifti(file->head(kNiftiHeadBytes));
  if (!header) bad_input(file->path(), "a NIfTI header (size 348 or 540 and its magic)", "other bytes");
  const std::vector<ArrayAxis> axes = axes_of(*header, file->path());
  const AxisChoice choice = choose_axes(axes, options, file->path());
  OpenedVolume volume;
  volume.info = read_info(*header, axes, choice, file->path());
  const std::uint64_t offset = data_offset(*header, file->path());
  if (!header->single_file) check_external(options, file->path(), "its image");
  const FilePtr image = header->single_file ? file : image_of_header(file->path());
  if (!header->single_file) volume.info.data_files = {image->path()};
  const std::size_t each = sample_bytes(volume.info.type);
  samples_in(image, offset, picked_extent(axes, choice, each, file->path()));  // refuses a file that cannot hold them
  const std::uint64_t whole = offset + checked_bytes_of(axes, each, file->path());
  if (image->size() < whole) {
    volume.info.notes.emplace_back("the file ends before the last of the volumes that its header says");
  }
  // A packed file's size is not known before all of it is inflated.
  if (image->jumps() && image->size() > whole) {
    volume.info.notes.push_back(std::to_string(image->size() - whole) +
                                " bytes behind the samples that the header describes are not read");
  }
  auto samples = std::make_unique<FileStream>(image, offset, image->size());
  volume.samples = pick_volume(std::move(samples), axes, choice, each, file->path());
  volume.swap_bytes = header->swapped;
  return volume;
}

}  // namespace isoweave
