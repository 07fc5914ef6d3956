// Headerless files: the layout comes from the caller or from the file's name.
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "files/header_text.hpp"
#include "isoweave/printable.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/images/slice_files.hpp"
#include "volume/formats/images/slice_numbers.hpp"
#include "volume/packed_file.hpp"

namespace isoweave {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// "WxHxD" with all three at least 1.
std::optional<std::array<std::int64_t, 3>> parse_dims(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, 'x');
  if (parts.size() != 3) return std::nullopt;
  std::array<std::int64_t, 3> dims{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<std::int64_t> side = parse_integer(parts[axis]);
    if (!side || *side < 1) return std::nullopt;
    dims[axis] = *side;
  }
  return dims;
}

[[noreturn]] void wrong_part(std::string_view part, std::string_view expected) {
  throw std::invalid_argument("raw layout: expected " + std::string(expected) + ", found '" + printable(part) + "'");
}

void parse_option(RawLayout& layout, std::string_view part) {
  constexpr std::string_view kSkip = "skip=";
  if (part == "big") {
    layout.big_endian = true;
  } else if (part == "little") {
    layout.big_endian = false;
  } else if (part.starts_with(kSkip)) {
    const std::optional<std::int64_t> skip = parse_integer(part.substr(kSkip.size()));
    if (!skip || *skip < 0) wrong_part(part, "skip=BYTES");
    layout.skip_bytes = *skip;
  } else {
    wrong_part(part, "'big', 'little' or 'skip=BYTES'");
  }
}

}  // namespace

RawLayout parse_raw_layout(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  if (parts.size() < 2) wrong_part(text, "WxHxD:TYPE");
  RawLayout layout;
  const auto dims = parse_dims(parts[0]);
  if (!dims) wrong_part(parts[0], "WxHxD with sides of at least 1");
  layout.dims = *dims;
  const auto type = parse_sample_type(parts[1]);
  if (!type) wrong_part(parts[1], "a type such as uint8, int16 or float32");
  layout.type = *type;
  for (std::size_t part = 2; part < parts.size(); ++part) parse_option(layout, parts[part]);
  return layout;
}

std::optional<RawLayout> raw_layout_from_name(std::string_view path) {
  constexpr std::string_view kRawEnding = ".raw";
  constexpr std::string_view kGzipEnding = ".gz";
  if (path.ends_with(kGzipEnding)) path.remove_suffix(kGzipEnding.size());
  if (!path.ends_with(kRawEnding)) return std::nullopt;
  path.remove_suffix(kRawEnding.size());
  path = path.substr(path.find_last_of('/') + 1);
  const std::vector<std::string_view> parts = split(path, '_');
  if (parts.size() < 2) return std::nullopt;
  const auto dims = parse_dims(parts[parts.size() - 2]);
  const auto type = parse_sample_type(parts.back());
  if (!dims || !type) return std::nullopt;
  return RawLayout{*dims, *type, false, 0};
}

namespace {

std::string layout_text(const RawLayout& layout) {
  const auto& [nx, ny, nz] = layout.dims;
  return std::to_string(nx) + "x" + std::to_string(ny) + "x" + std::to_string(nz) + ":" +
         std::string(sample_type_name(layout.type)) + (layout.big_endian ? ":big" : "") +
         ":skip=" + std::to_string(layout.skip_bytes);
}

VolumeInfo raw_info(const std::string& path, const RawLayout& layout) {
  VolumeInfo info;
  info.path = path;
  info.format = "raw";
  info.dims = layout.dims;
  info.type = layout.type;
  info.layout = layout_text(layout);
  checked_volume_bytes(info);
  if (layout.skip_bytes < 0) bad_input(path, "a skip of at least 0", std::to_string(layout.skip_bytes));
  return info;
}

// Names the layout that a file of another size would fit: samples of another type, or a header to skip.
std::string fitting_layout(std::uint64_t size, const RawLayout& layout, std::uint64_t bytes) {
  constexpr std::pair<std::uint64_t, std::string_view> kTypes[] = {
      {1, "uint8 or int8"}, {2, "uint16 or int16"}, {4, "float32 or int32"}, {8, "float64 or int64"}};
  const auto skip = static_cast<std::uint64_t>(layout.skip_bytes);
  const std::uint64_t samples = bytes / sample_bytes(layout.type);
  for (const auto& [each, types] : kTypes) {
    if (size > skip && size - skip == each * samples) return ": perhaps " + std::string(types) + "?";
  }
  return size > skip + bytes ? ": perhaps skip=" + std::to_string(size - bytes) + "?" : "";
}

// The `bytes` behind the skip, which end the file.
std::unique_ptr<ByteStream> samples_to_end(const FilePtr& file, const RawLayout& layout, std::uint64_t bytes) {
  const auto skip = static_cast<std::uint64_t>(layout.skip_bytes);
  // Both are below 2^63, so the sum does not wrap.
  if (file->exact_size() != skip + bytes) {
    bad_input(file->path(), std::to_string(skip + bytes) + " bytes by its layout",
              std::to_string(file->size()) + fitting_layout(file->size(), layout, bytes));
  }
  return std::make_unique<FileStream>(file, skip, skip + bytes);
}

bool is_swapped(const RawLayout& layout) { return layout.big_endian != (std::endian::native == std::endian::big); }

}  // namespace

bool fits_raw(const InputFile& file, const RawLayout& layout) {
  const std::uint64_t bytes = checked_volume_bytes(raw_info(file.path(), layout));
  return file.size() == static_cast<std::uint64_t>(layout.skip_bytes) + bytes;
}

OpenedVolume open_raw(const FilePtr& file, const RawLayout& layout) {
  OpenedVolume volume;
  volume.info = raw_info(file->path(), layout);
  volume.samples = samples_to_end(file, layout, checked_volume_bytes(volume.info));
  volume.swap_bytes = is_swapped(layout);
  return volume;
}

OpenedVolume open_raw_slices(const std::string& path, const OpenOptions& options) {
  const RawLayout layout = options.raw.value();
  OpenedVolume volume;
  volume.info = raw_info(path, layout);
  const std::vector<std::string> files = files_of(path, options);
  const auto count = static_cast<std::int64_t>(files.size());
  if (count != layout.dims[2]) {
    const char* const files_of_layout = layout.dims[2] == 1 ? " file" : " files";
    bad_input(path, std::to_string(layout.dims[2]) + files_of_layout + " by the layout, one for each slice",
              std::to_string(count));
  }
  const std::uint64_t slice = volume.info.slice_bytes();
  const auto name = [files](std::int64_t n) { return files[static_cast<std::size_t>(n)]; };
  const auto open = [=](std::int64_t n) { return samples_to_end(unpacked(open_file(name(n))), layout, slice); };
  // A file that is missing or of another size is found now.
  for (std::int64_t n = 0; n < count; ++n) open(n);
  volume.info.notes = notes_on_numbers(files);
  volume.info.data_files = files;
  volume.samples = std::make_unique<FileSequence>(count, slice, open, name);
  volume.swap_bytes = is_swapped(layout);
  return volume;
}

}  // namespace isoweave
