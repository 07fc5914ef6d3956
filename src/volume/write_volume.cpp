// Writes a source to a file, a few slices at a time.
#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "files/atomic_file.hpp"
#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "isoweave/error.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/printable.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

constexpr bool kBigEndian = std::endian::native == std::endian::big;

enum class Format { kNrrd, kMetaImage, kRaw };

Format format_of(const std::string& path) {
  const std::string name = lower_case(path);
  if (name.ends_with(".nrrd")) return Format::kNrrd;
  if (name.ends_with(".mha")) return Format::kMetaImage;
  if (name.ends_with(".raw")) return Format::kRaw;
  throw CannotWrite(printable(path) + ": expected a name ending in .nrrd, .mha or .raw");
}

std::string joined(const std::array<double, 3>& values, std::string_view separator) {
  return number_text(values[0]) + std::string(separator) + number_text(values[1]) + std::string(separator) +
         number_text(values[2]);
}

std::string dims_text(const VolumeInfo& info) {
  return std::to_string(info.dims[0]) + " " + std::to_string(info.dims[1]) + " " + std::to_string(info.dims[2]);
}

// Unit direction of an axis, times `scale`.
std::array<double, 3> direction_of(const Geometry& geometry, std::size_t axis, double scale) {
  return {geometry.direction[axis] * scale, geometry.direction[3 + axis] * scale, geometry.direction[6 + axis] * scale};
}

std::string nrrd_type(SampleType type) {
  if (type == SampleType::kFloat32) return "float";
  if (type == SampleType::kFloat64) return "double";
  return std::string(sample_type_name(type));
}

std::string nrrd_space(const Geometry& geometry) {
  if (geometry.space == Space::kLps) return "space: left-posterior-superior\n";
  if (geometry.space == Space::kRas) return "space: right-anterior-superior\n";
  return "space dimension: 3\n";
}

std::string nrrd_header(const VolumeInfo& info) {
  const Geometry& geometry = info.geometry;
  std::string text = "NRRD0004\ntype: " + nrrd_type(info.type) + "\ndimension: 3\n" + nrrd_space(geometry);
  text += "sizes: " + dims_text(info) + "\nspace directions:";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += " (" + joined(direction_of(geometry, axis, geometry.spacing[axis]), ",") + ")";
  }
  text += "\nkinds: domain domain domain\nspace origin: (" + joined(geometry.origin, ",") + ")\n";
  if (!geometry.unit.empty()) {
    const std::string unit = " \"" + geometry.unit + "\"";
    text += "space units:" + unit + unit + unit + "\n";
  }
  text += kBigEndian ? "endian: big\n" : "endian: little\n";
  return text + "encoding: raw\n\n";
}

std::string metaimage_type(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return "MET_UCHAR";
    case SampleType::kInt8:
      return "MET_CHAR";
    case SampleType::kUint16:
      return "MET_USHORT";
    case SampleType::kInt16:
      return "MET_SHORT";
    case SampleType::kUint32:
      return "MET_UINT";
    case SampleType::kInt32:
      return "MET_INT";
    case SampleType::kUint64:
      return "MET_ULONG_LONG";
    case SampleType::kInt64:
      return "MET_LONG_LONG";
    case SampleType::kFloat32:
      return "MET_FLOAT";
    case SampleType::kFloat64:
      return "MET_DOUBLE";
  }
  return {};
}

// MetaImage is always LPS; RAS differs in the sign of x and y.
Geometry as_lps(Geometry geometry) {
  if (geometry.space != Space::kRas) return geometry;
  for (std::size_t n = 0; n < 6; ++n) geometry.direction[n] = -geometry.direction[n];
  geometry.origin[0] = -geometry.origin[0];
  geometry.origin[1] = -geometry.origin[1];
  geometry.space = Space::kLps;
  return geometry;
}

std::string metaimage_header(const VolumeInfo& info) {
  const Geometry geometry = as_lps(info.geometry);
  std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = ";
  text += kBigEndian ? "True\n" : "False\n";
  text += "CompressedData = False\nTransformMatrix = " + joined(direction_of(geometry, 0, 1), " ") + " " +
          joined(direction_of(geometry, 1, 1), " ") + " " + joined(direction_of(geometry, 2, 1), " ");
  text += "\nOffset = " + joined(geometry.origin, " ") + "\nElementSpacing = " + joined(geometry.spacing, " ");
  if (!geometry.unit.empty()) text += "\nDistanceUnits = " + geometry.unit;
  return text + "\nDimSize = " + dims_text(info) + "\nElementType = " + metaimage_type(info.type) +
         "\nElementDataFile = LOCAL\n";
}

// Neither header has a place for it that readers agree on, and samples whose meaning changes on the way are worse
// than no file. A raw file carries no meaning at all.
void refuse_scaled(const VolumeInfo& info, const std::string& path, Format format) {
  if (format == Format::kRaw || (info.slope == 1 && info.intercept == 0)) return;
  throw CannotWrite(printable(path) + ": this format cannot carry the scaling of " + printable(info.path) + " (slope " +
                    number_text(info.slope) + ", intercept " + number_text(info.intercept) + ")");
}

}  // namespace

void write_volume(SliceSource& source, const std::string& path) {
  const StandardFloats floats;
  const VolumeInfo& info = source.info();
  const Format format = format_of(path);
  refuse_scaled(info, path, format);
  AtomicFile file(path);
  const std::string header = format == Format::kNrrd        ? nrrd_header(info)
                             : format == Format::kMetaImage ? metaimage_header(info)
                                                            : std::string();
  file.write(std::as_bytes(std::span(header)));
  constexpr std::size_t kChunkBytes = 4 << 20;
  const auto at_once = static_cast<std::int64_t>(std::max<std::size_t>(1, kChunkBytes / info.slice_bytes()));
  const std::int64_t chunk = std::min(at_once, info.dims[2]);
  std::vector<std::byte> slices(to_size(chunk, info.slice_bytes()));
  for (std::int64_t first = 0; first < info.dims[2]; first += chunk) {
    const std::int64_t count = std::min(chunk, info.dims[2] - first);
    source.read(first, count, slices);
    file.write(std::span<const std::byte>(slices).first(static_cast<std::size_t>(count) * info.slice_bytes()));
  }
  file.commit();
}

}  // namespace isoweave
