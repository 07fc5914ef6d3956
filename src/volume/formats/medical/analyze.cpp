// Analyze 7.5: a binary header of either byte order (.hdr) beside the samples (.img), as NIfTI has it, without a magic
// and without a word about left and right. SPM's two versions keep a scale in fields that are free.
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "files/header_text.hpp"
#include "volume/axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/medical/type_codes.hpp"
#include "volume/formats/other/header_fields.hpp"
#include "volume/volumes_in_row.hpp"

namespace isoweave {
namespace {

constexpr std::int32_t kAnalyzeBytes = 348;

// SPM's.
constexpr std::array<TypeCode, 3> kAnalyzeAddedTypes{
    {{130, SampleType::kInt8}, {132, SampleType::kUint16}, {136, SampleType::kUint32}}};
constexpr TypeCodes kAnalyzeTypes{"Analyze", "a scalar type of 8 to 32 bit integers or 32 or 64 bit floats",
                                  kAnalyzeAddedTypes};

struct AnalyzeHeader {
  bool swapped = false;
  std::array<std::int64_t, 8> dim{};
  std::int64_t type = 0;
  std::array<double, 8> pixdim{};
  double offset = 0;
  double scale = 0;
  int orientation = 0;
  std::array<std::int64_t, 3> origin{};  // SPM's, a sample counted from 1
};

std::optional<AnalyzeHeader> parse_analyze(std::string_view bytes) {
  if (bytes.size() < kAnalyzeBytes) return std::nullopt;
  for (const bool swapped : {false, true}) {
    const HeaderFields field(bytes, swapped);
    if (field.at<std::int32_t>(0) != kAnalyzeBytes) continue;
    AnalyzeHeader header;
    header.swapped = swapped;
    field.fill<std::int16_t>(header.dim, 40);
    header.type = field.at<std::int16_t>(70);
    field.fill<float>(header.pixdim, 76);
    header.offset = static_cast<double>(field.at<float>(108));
    header.scale = static_cast<double>(field.at<float>(112));
    header.orientation = field.at<std::uint8_t>(252);
    field.fill<std::int16_t>(header.origin, 253);
    return header;
  }
  return std::nullopt;
}

// Returns how many volumes there are.
std::int64_t set_dims(const AnalyzeHeader& header, VolumeInfo& info) {
  const std::int64_t rank = header.dim[0];
  if (rank < 2 || rank > 7) bad_input(info.path, "2 to 7 dimensions", std::to_string(rank));
  std::int64_t volumes = 1;
  for (std::size_t axis = 1; static_cast<std::int64_t>(axis) <= rank; ++axis) {
    // Axes that are not used have 0 or 1 samples. Four factors below 2^15 fit.
    const std::int64_t side = axis <= 2 ? header.dim[axis] : std::max<std::int64_t>(1, header.dim[axis]);
    if (axis <= 3) info.dims[axis - 1] = side;
    if (axis > 3) volumes *= side;
  }
  info.dims[2] = std::max<std::int64_t>(1, info.dims[2]);
  return volumes;
}

// Sets the axes. The format does not say which side is left, nor where the origin is.
void set_axes(const AnalyzeHeader& header, VolumeInfo& info) {
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double spacing = std::abs(header.pixdim[axis + 1]);
    if (spacing == 0) {
      spacing = 1;
      info.notes.push_back("the spacing of axis " + std::to_string(axis) + " is 0 in the file and taken as 1");
    }
    axes.steps[axis][axis] = spacing;
  }
  set_geometry(info.geometry, axes, info.path);
  info.geometry.unit = "mm";
  std::string note = "Analyze does not say which side is left: axes and samples are as stored (orient " +
                     std::to_string(header.orientation) + ")";
  if (header.origin != std::array<std::int64_t, 3>{}) {
    note += ", and SPM's origin, sample " + std::to_string(header.origin[0]) + " " + std::to_string(header.origin[1]) +
            " " + std::to_string(header.origin[2]) + " counted from 1, is not applied";
  }
  info.notes.push_back(note);
}

void set_scale(const AnalyzeHeader& header, VolumeInfo& info) {
  if (!std::isfinite(header.scale) || header.scale == 0 || header.scale == 1) return;
  info.slope = header.scale;
  info.notes.push_back("values are scaled by " + number_text(header.scale) +
                       ", which SPM keeps in a field that Analyze leaves free");
}

std::uint64_t data_offset(const AnalyzeHeader& header, std::string_view path) {
  constexpr double kLargest = 4e18;
  // A negative one counts blocks of volumes of different sizes.
  if (!(header.offset >= 0) || header.offset > kLargest) {
    bad_input(path, "samples from byte 0 or a later one on", "an offset of " + number_text(header.offset));
  }
  return static_cast<std::uint64_t>(header.offset);
}

}  // namespace

bool is_analyze(std::string_view head) {
  const std::optional<AnalyzeHeader> header = parse_analyze(head);
  return header && header->dim[0] >= 1 && header->dim[0] <= 7;
}

OpenedVolume open_analyze(const FilePtr& file, const OpenOptions& options) {
  const std::optional<AnalyzeHeader> header = parse_analyze(file->head(kAnalyzeBytes));
  if (!header) bad_input(file->path(), "an Analyze header, whose first number is 348", "other content");
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "analyze";
  info.type = type_of_code(header->type, kAnalyzeTypes, info.path);
  const std::int64_t volumes = set_dims(*header, info);
  const std::uint64_t before = choose_in_row(info, volumes, options);
  set_axes(*header, info);
  set_scale(*header, info);
  const std::uint64_t begin = data_offset(*header, info.path) + before;
  const FilePtr image = image_of_header(info.path);
  info.data_files = {image->path()};
  volume.samples = samples_in(image, begin, checked_volume_bytes(info));
  volume.swap_bytes = header->swapped;
  return volume;
}

}  // namespace isoweave
