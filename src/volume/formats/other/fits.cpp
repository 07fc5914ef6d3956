// FITS images: cards of 80 characters in blocks of 2880 bytes, then the samples, the most significant byte first.
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/formats/formats.hpp"
#include "volume/volumes_in_row.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kCard = 80;
constexpr std::size_t kFitsBlock = 2880;

struct FitsHeader {
  std::map<std::string, std::string, std::less<>> values;  // by keyword, without comments
  std::uint64_t data = 0;
};

FitsHeader read_fits_header(const FilePtr& file) {
  const std::string head = file->head(kLargestHeader);
  FitsHeader header;
  for (std::size_t at = 0; at + kCard <= head.size(); at += kCard) {
    const std::string_view card = std::string_view(head).substr(at, kCard);
    const std::string key(trimmed(card.substr(0, 8)));
    if (key == "END") {
      header.data = (at + kCard + kFitsBlock - 1) / kFitsBlock * kFitsBlock;
      return header;
    }
    if (card.substr(8, 2) != "= ") continue;
    const std::string_view value = card.substr(10);
    header.values[key] = trimmed(value.substr(0, value.find('/')));
  }
  bad_input(file->path(), "the card END of a FITS header", "none");
}

std::int64_t integer_of(const FitsHeader& header, const std::string& key, const std::string& path) {
  const auto found = header.values.find(key);
  const auto value = found == header.values.end() ? std::nullopt : parse_integer(found->second);
  if (!value)
    bad_input(path, "a whole number as " + key, found == header.values.end() ? "none" : in_quotes(found->second));
  return *value;
}

double number_of(const FitsHeader& header, const std::string& key, double missing, const std::string& path) {
  const auto found = header.values.find(key);
  if (found == header.values.end()) return missing;
  const auto value = parse_double(with_exponent_e(found->second));
  if (!value) bad_input(path, "a number as " + key, in_quotes(found->second));
  return *value;
}

SampleType sample_type_of(std::int64_t bits, const std::string& path) {
  switch (bits) {
    case 8:
      return SampleType::kUint8;
    case 16:
      return SampleType::kInt16;
    case 32:
      return SampleType::kInt32;
    case 64:
      return SampleType::kInt64;
    case -32:
      return SampleType::kFloat32;
    case -64:
      return SampleType::kFloat64;
    default:
      bad_input(path, "BITPIX 8, 16, 32, 64, -32 or -64", std::to_string(bits));
  }
}

// Returns how many volumes there are along the axes beyond the third.
std::int64_t set_dims(const FitsHeader& header, VolumeInfo& info) {
  const std::int64_t axes = integer_of(header, "NAXIS", info.path);
  constexpr std::int64_t kMostAxes = 999;
  if (axes < 2 || axes > kMostAxes) {
    bad_input(info.path, "an image of 2 axes or more in the first part of the file",
              axes == 0 ? "none (extensions are not read)" : std::to_string(axes) + " axes");
  }
  info.dims = {1, 1, 1};
  std::int64_t volumes = 1;
  for (std::int64_t n = 1; n <= axes; ++n) {
    const std::int64_t side = integer_of(header, "NAXIS" + std::to_string(n), info.path);
    if (n <= 3) info.dims[static_cast<std::size_t>(n - 1)] = side;
    if (n > 3 && __builtin_mul_overflow(volumes, side, &volumes)) {
      bad_input(info.path, "fewer than 2^63 volumes", "axes whose product is larger");
    }
  }
  return volumes;
}

}  // namespace

bool is_fits(std::string_view head) { return head.starts_with("SIMPLE  ="); }

OpenedVolume open_fits(const FilePtr& file, const OpenOptions& options) {
  const FitsHeader header = read_fits_header(file);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "fits";
  info.type = sample_type_of(integer_of(header, "BITPIX", info.path), info.path);
  const std::int64_t volumes = set_dims(header, info);
  const std::uint64_t before = choose_in_row(info, volumes, options);
  info.slope = number_of(header, "BSCALE", 1, info.path);
  info.intercept = number_of(header, "BZERO", 0, info.path);
  if (info.slope == 0 || !std::isfinite(info.slope) || !std::isfinite(info.intercept)) {
    bad_input(info.path, "a BSCALE other than 0", number_text(info.slope));
  }
  if (header.values.contains("BLANK")) {
    info.notes.push_back("BLANK is not applied: samples of " + in_quotes(header.values.find("BLANK")->second) +
                         " are values");
  }
  info.notes.emplace_back("coordinates of the sky and of spectra are not applied: the spacing is taken as 1");
  volume.samples = samples_in(file, header.data + before, checked_volume_bytes(info));
  volume.swap_bytes = std::endian::native == std::endian::little;
  return volume;
}

}  // namespace isoweave
