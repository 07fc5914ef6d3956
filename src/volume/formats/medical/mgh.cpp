// FreeSurfer's MGH, and MGZ, which is MGH in gzip: a header of 284 bytes and the samples, the most significant byte
// first.
#include <array>
#include <bit>
#include <optional>
#include <string>

#include "volume/axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/header_fields.hpp"
#include "volume/volumes_in_row.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kMghBytes = 284;
constexpr std::size_t kFieldBytes = 90;  // of the header, the rest is not used
constexpr bool kSwapped = std::endian::native == std::endian::little;

struct MghHeader {
  std::array<std::int32_t, 7> numbers{};  // version, width, height, depth, frames, type, degrees of freedom
  bool placed = false;
  std::array<double, 3> spacing{};
  std::array<double, 9> directions{};  // x, y, z of axis i, then of j, of k
  Vector3 centre{};                    // of the volume: of the sample at half of the dimensions
};

MghHeader parse_mgh(std::string_view bytes) {
  const HeaderFields field(bytes, kSwapped);
  MghHeader header;
  field.fill<std::int32_t>(header.numbers, 0);
  header.placed = field.at<std::int16_t>(28) == 1;
  field.fill<float>(header.spacing, 30);
  field.fill<float>(header.directions, 42);
  field.fill<float>(header.centre, 78);
  return header;
}

std::optional<SampleType> type_of(std::int32_t code) {
  switch (code) {
    case 0:
      return SampleType::kUint8;
    case 1:
      return SampleType::kInt32;
    case 3:
      return SampleType::kFloat32;
    case 4:
      return SampleType::kInt16;
    case 8:
      return SampleType::kFloat64;
    case 10:
      return SampleType::kUint16;
    default:
      return std::nullopt;
  }
}

// Places a volume that does not say where it is, as FreeSurfer does: coronal slices of 1 mm around the origin.
void place_by_default(MghHeader& header, VolumeInfo& info) {
  if (header.placed) return;
  header.spacing = {1, 1, 1};
  header.directions = {-1, 0, 0, 0, 0, -1, 0, 1, 0};
  header.centre = {0, 0, 0};
  info.notes.emplace_back("the file does not say where it lies; taken as coronal slices of 1 mm around the origin");
}

void set_axes(const MghHeader& header, VolumeInfo& info) {
  Axes axes;
  axes.origin = header.centre;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t row = 0; row < 3; ++row) {
      axes.steps[axis][row] = header.directions[3 * axis + row] * header.spacing[axis];
      axes.origin[row] -= axes.steps[axis][row] * static_cast<double>(info.dims[axis]) / 2;
    }
  }
  set_geometry(info.geometry, axes, info.path);
  info.geometry.space = Space::kRas;
  info.geometry.unit = "mm";
}

}  // namespace

// There is no magic: the numbers must be those of a header.
bool is_mgh(std::string_view head) {
  if (head.size() < kFieldBytes) return false;
  const std::array<std::int32_t, 7> numbers = parse_mgh(head).numbers;
  constexpr std::int32_t kTypes = 12;  // codes that FreeSurfer knows
  bool sane = numbers[0] == 1 && numbers[5] >= 0 && numbers[5] < kTypes;
  for (std::size_t n = 1; n < 5; ++n) sane = sane && numbers[n] > 0;
  return sane;
}

OpenedVolume open_mgh(const FilePtr& file, const OpenOptions& options) {
  const std::string head = file->head(kMghBytes);
  if (!is_mgh(head)) bad_input(file->path(), "an MGH header: version 1, dimensions of at least 1", "other content");
  MghHeader header = parse_mgh(head);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "mgh";
  const std::optional<SampleType> type = type_of(header.numbers[5]);
  if (!type) {
    bad_input(info.path, "the MGH type 0, 1, 3, 4, 8 or 10 (8- to 32-bit integers or floats)",
              std::to_string(header.numbers[5]));
  }
  info.type = *type;
  for (std::size_t axis = 0; axis < 3; ++axis) info.dims[axis] = header.numbers[axis + 1];
  const std::uint64_t before = choose_in_row(info, header.numbers[4], options);
  place_by_default(header, info);
  set_axes(header, info);
  volume.samples = samples_in(file, kMghBytes + before, checked_volume_bytes(info));
  volume.swap_bytes = kSwapped;
  return volume;
}

}  // namespace isoweave
