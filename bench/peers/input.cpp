#include "input.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "isoweave/generate.hpp"

namespace bench {
namespace {

constexpr std::string_view kGenerated = "generate:";

std::unique_ptr<isoweave::SliceSource> generated(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    throw std::invalid_argument("expected generate:KIND:WxHxD:TYPE, found 'generate:" + std::string(text) + "'");
  }
  const isoweave::RawLayout layout = isoweave::parse_raw_layout(text.substr(colon + 1));
  isoweave::GenerateOptions options;
  options.kind = text.substr(0, colon);
  options.dims = layout.dims;
  options.type = layout.type;
  return isoweave::generate_volume(options);
}

std::array<double, 3> parse_spacing(const std::string& text) {
  std::array<double, 3> spacing{};
  std::istringstream stream(text);
  char comma = ',';
  stream >> spacing[0] >> comma >> spacing[1] >> comma >> spacing[2];
  if (!stream || !stream.eof()) throw std::invalid_argument("--spacing: expected x,y,z, found '" + text + "'");
  return spacing;
}

}  // namespace

std::unique_ptr<isoweave::SliceSource> open_source(const VolumeName& name) {
  if (name.path.starts_with(kGenerated)) return generated(std::string_view(name.path).substr(kGenerated.size()));
  isoweave::OpenOptions options;
  if (!name.raw.empty()) options.raw = isoweave::parse_raw_layout(name.raw);
  if (!name.spacing.empty()) options.spacing = parse_spacing(name.spacing);
  return isoweave::open_volume(name.path, options);
}

double stored_iso(const isoweave::VolumeInfo& info, double iso) { return (iso - info.intercept) / info.slope; }

double mean_voxel(const isoweave::VolumeInfo& info) {
  const std::array<double, 3>& spacing = info.geometry.spacing;
  return std::cbrt(spacing[0] * spacing[1] * spacing[2]);
}

HeldVolume hold(isoweave::SliceSource& source, double iso) {
  HeldVolume volume{source.info(), {}, iso};
  volume.samples.resize(volume.info.slice_bytes() * static_cast<std::size_t>(volume.info.dims[2]));
  source.read(0, volume.info.dims[2], volume.samples);
  return volume;
}

VolumeFile write_raw(isoweave::SliceSource& source, double iso, const std::string& path) {
  VolumeFile file{source.info(), stored_iso(source.info(), iso)};
  isoweave::write_volume(source, path);
  file.info.path = path;
  file.info.slope = 1;
  file.info.intercept = 0;
  return file;
}

std::unique_ptr<isoweave::SliceSource> open_source(const VolumeFile& file) {
  isoweave::OpenOptions options;
  options.raw = isoweave::RawLayout{.dims = file.info.dims, .type = file.info.type};
  options.spacing = file.info.geometry.spacing;
  return isoweave::open_volume(file.info.path, options);
}

}  // namespace bench
