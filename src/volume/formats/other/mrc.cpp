// MRC and CCP4 maps of electron microscopy and crystallography: a header of 1024 bytes, an extended one, the samples.
// After "MRC2014: Extensions to the MRC format header for electron cryo-microscopy and tomography" (2015), and IMOD's
// description of its own additions.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "files/header_text.hpp"
#include "volume/axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/header_fields.hpp"
#include "volume/half_floats.hpp"
#include "volume/volumes_in_row.hpp"

namespace isoweave {
namespace {

constexpr std::int32_t kImodStamp = 1146047817;
constexpr std::int32_t kImodSignedBytes = 1;
constexpr std::int32_t kImodTurnedOrigin = 4;
constexpr std::int32_t kStackOfVolumes = 401;  // space group
constexpr std::int32_t kHalfMode = 12;         // 16-bit floats

struct MrcHeader {
  bool swapped = false;
  std::array<std::int32_t, 3> dims{};  // columns, rows, sections
  std::int32_t mode = 0;
  std::array<std::int32_t, 3> start{};  // of the first column, row, section, in samples
  std::array<std::int32_t, 3> grid{};   // samples of the cell along x, y, z
  std::array<double, 3> cell{};         // in angstrom
  std::array<double, 3> angles{};       // in degrees: between y and z, x and z, x and y
  std::array<std::int32_t, 3> axes{};   // 1, 2, 3 for x, y, z: along columns, rows, sections
  double smallest = 0;
  double largest = 0;
  std::int32_t group = 0;
  std::int32_t extended = 0;  // bytes
  bool imod = false;
  std::int32_t imod_flags = 0;
  std::array<double, 3> origin{};  // in angstrom
};

MrcHeader parse_header(std::string_view bytes, bool swapped) {
  const HeaderFields field(bytes, swapped);
  MrcHeader header;
  header.swapped = swapped;
  field.fill<std::int32_t>(header.dims, 0);
  header.mode = field.at<std::int32_t>(12);
  field.fill<std::int32_t>(header.start, 16);
  field.fill<std::int32_t>(header.grid, 28);
  field.fill<float>(header.cell, 40);
  field.fill<float>(header.angles, 52);
  field.fill<std::int32_t>(header.axes, 64);
  header.smallest = static_cast<double>(field.at<float>(76));
  header.largest = static_cast<double>(field.at<float>(80));
  header.group = field.at<std::int32_t>(88);
  header.extended = field.at<std::int32_t>(92);
  header.imod = field.at<std::int32_t>(152) == kImodStamp;
  header.imod_flags = field.at<std::int32_t>(156);
  field.fill<float>(header.origin, 196);
  return header;
}

// Axes left at zero are those of old writers, in order.
bool is_order_of_axes(std::array<std::int32_t, 3> axes) {
  std::sort(axes.begin(), axes.end());
  return axes == std::array<std::int32_t, 3>{1, 2, 3} || axes == std::array<std::int32_t, 3>{0, 0, 0};
}

bool is_plausible(const MrcHeader& header) {
  constexpr std::int32_t kModes = 1024;
  return std::all_of(header.dims.begin(), header.dims.end(), [](std::int32_t side) { return side > 0; }) &&
         header.mode >= 0 && header.mode < kModes && is_order_of_axes(header.axes);
}

std::int32_t longest_side(const MrcHeader& header) { return *std::max_element(header.dims.begin(), header.dims.end()); }

// The header in the byte order in which it makes sense, or more sense. The machine stamp is not used: files in use have
// wrong ones.
std::optional<MrcHeader> find_header(std::string_view bytes) {
  if (bytes.size() < kMrcHeadBytes) return std::nullopt;
  const MrcHeader header = parse_header(bytes, false);
  const MrcHeader swapped = parse_header(bytes, true);
  if (!is_plausible(header) && !is_plausible(swapped)) return std::nullopt;
  if (!is_plausible(swapped)) return header;
  if (!is_plausible(header)) return swapped;
  return longest_side(header) <= longest_side(swapped) ? header : swapped;
}

// Bytes are signed by the standard, and were not in older files. IMOD says which; else values above 127 do.
SampleType byte_type(const MrcHeader& header, VolumeInfo& info) {
  constexpr double kLargestSigned = 127;
  if (header.imod) return (header.imod_flags & kImodSignedBytes) != 0 ? SampleType::kInt8 : SampleType::kUint8;
  if (header.smallest >= 0 && header.largest > kLargestSigned) {
    info.notes.push_back("bytes are taken as unsigned, since the header says that values reach " +
                         number_text(header.largest));
    return SampleType::kUint8;
  }
  return SampleType::kInt8;
}

SampleType sample_type_of(const MrcHeader& header, VolumeInfo& info) {
  std::string name;
  switch (header.mode) {
    case 0:
      return byte_type(header, info);
    case 1:
      return SampleType::kInt16;
    case 2:
      return SampleType::kFloat32;
    case 6:
    case kHalfMode:
      return SampleType::kUint16;
    case 3:
    case 4:
      name = " (complex numbers)";
      break;
    case 16:
      name = " (RGB)";
      break;
    case 101:
      name = " (4 bits per sample)";
      break;
    default:
      break;
  }
  bad_input(info.path, "the MRC mode 0, 1, 2, 6 or 12 (8- or 16-bit integers, 16- or 32-bit floats)",
            std::to_string(header.mode) + name);
}

// Volumes in a stack: each is as deep as the cell.
std::int64_t set_dims(const MrcHeader& header, VolumeInfo& info) {
  for (std::size_t axis = 0; axis < 3; ++axis) info.dims[axis] = header.dims[axis];
  const std::int32_t depth = header.grid[2];
  if (header.group < kStackOfVolumes || depth < 1 || depth >= header.dims[2] || header.dims[2] % depth != 0) return 1;
  info.dims[2] = depth;
  return header.dims[2] / depth;
}

constexpr double kNanometres = 0.1;  // of an angstrom

// Distances along x, y and z. One that is not given, as in single images, is that of another axis.
std::array<double, 3> distances_of(const MrcHeader& header, VolumeInfo& info) {
  std::array<double, 3> step{};
  double given = 0;
  for (std::size_t n = 3; n-- > 0;) {
    const double distance = header.grid[n] > 0 ? header.cell[n] / header.grid[n] : 0;
    if (std::isfinite(distance) && distance > 0) step[n] = given = kNanometres * distance;
  }
  if (given > 0) info.geometry.unit = "nm";
  for (std::size_t n = 0; n < 3; ++n) {
    if (step[n] > 0) continue;
    step[n] = given > 0 ? given : 1;
    info.notes.push_back("the spacing along " + std::string(1, "xyz"[n]) + " is not given and taken as " +
                         number_text(step[n]));
  }
  return step;
}

// The cosine of an angle of the cell; 0 degrees are those of writers that leave angles out.
double cosine_of(double degrees) {
  constexpr double kRight = 90;
  return degrees == 0 || degrees == kRight ? 0 : std::cos(degrees * std::numbers::pi / 180);
}

// The steps along x, y and z; those along y and z lean as the angles of the cell say.
std::array<Vector3, 3> steps_of_cell(const MrcHeader& header, VolumeInfo& info) {
  const std::array<double, 3> step = distances_of(header, info);
  const double yz = cosine_of(header.angles[0]);
  const double xz = cosine_of(header.angles[1]);
  const double xy = cosine_of(header.angles[2]);
  const double sine = std::sqrt(1 - xy * xy);
  const double lean = (yz - xz * xy) / sine;
  const double height = std::sqrt(1 - xz * xz - lean * lean);
  return {Vector3{step[0], 0, 0}, Vector3{step[1] * xy, step[1] * sine, 0},
          Vector3{step[2] * xz, step[2] * lean, step[2] * height}};
}

// The origin if there is one, else the place of the first sample in the grid of the cell. Files with both mean the
// first.
Vector3 origin_of(const MrcHeader& header, const Axes& axes, VolumeInfo& info) {
  Vector3 origin{0, 0, 0};
  const bool started = header.start != std::array<std::int32_t, 3>{};
  if (header.origin == std::array<double, 3>{}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t row = 0; row < 3; ++row) origin[row] += axes.steps[axis][row] * header.start[axis];
    }
    return origin;
  }
  const bool turned = header.imod && (header.imod_flags & kImodTurnedOrigin) == 0;
  const double scale = (info.geometry.unit.empty() ? 1 : kNanometres) * (turned ? -1 : 1);
  for (std::size_t row = 0; row < 3; ++row) origin[row] = scale * header.origin[row];
  if (turned) info.notes.emplace_back("the origin has the sign of IMOD's files and is turned");
  if (started) info.notes.emplace_back("the file has an origin and a first index; the origin is taken");
  return origin;
}

void set_axes(const MrcHeader& header, VolumeInfo& info) {
  const std::array<Vector3, 3> steps = steps_of_cell(header, info);
  const bool ordered = header.axes[0] > 0;
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes.steps[axis] = steps[ordered ? static_cast<std::size_t>(header.axes[axis] - 1) : axis];
  }
  axes.origin = origin_of(header, axes, info);
  set_geometry(info.geometry, axes, info.path);
}

}  // namespace

bool is_mrc(std::string_view head) {
  constexpr std::size_t kMapWord = 208;
  return head.size() >= kMrcHeadBytes && head.substr(kMapWord, 3) == "MAP" && find_header(head).has_value();
}

bool is_old_mrc(std::string_view head) { return find_header(head).has_value(); }

OpenedVolume open_mrc(const FilePtr& file, const OpenOptions& options) {
  const std::optional<MrcHeader> header = find_header(file->head(kMrcHeadBytes));
  if (!header)
    bad_input(file->path(), "an MRC header: dimensions of at least 1, a mode, axes 1, 2, 3", "other content");
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "mrc";
  info.type = sample_type_of(*header, info);
  const std::int64_t volumes = set_dims(*header, info);
  const std::uint64_t before = choose_in_row(info, volumes, options);
  set_axes(*header, info);
  if (header->extended < 0) {
    bad_input(info.path, "an extended header of at least 0 bytes", std::to_string(header->extended));
  }
  const std::uint64_t begin = kMrcHeadBytes + static_cast<std::uint64_t>(header->extended);
  volume.samples = samples_in(file, begin + before, checked_volume_bytes(info));
  volume.swap_bytes = header->swapped;
  if (header->mode == kHalfMode) read_halves(volume);
  return volume;
}

}  // namespace isoweave
