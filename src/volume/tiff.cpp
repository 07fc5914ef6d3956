// TIFF and BigTIFF stacks through libtiff: one directory per slice, in strips or tiles, of any compression that libtiff
// decodes.
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "volume/formats.hpp"
#include "volume/geometry.hpp"
#include "volume/stack_description.hpp"
#include "volume/tiff_file.hpp"
#include "volume/tiff_pages.hpp"
#include "volume/tiff_stream.hpp"

namespace isoweave {
namespace {

std::string description_of(const TiffFile& tiff) {
  const char* text = nullptr;
  if (TIFFGetField(tiff.handle(), TIFFTAG_IMAGEDESCRIPTION, &text) != 1 || text == nullptr) return {};
  return text;
}

// Samples per unit of length along x and y, as ImageJ uses the tags of a printer's resolution.
void use_resolution(StackDescription& stack, const TiffFile& tiff) {
  constexpr float kPrinter = 72;
  const std::array<float, 2> resolution{tiff.field<float>(TIFFTAG_XRESOLUTION, 0),
                                        tiff.field<float>(TIFFTAG_YRESOLUTION, 0)};
  const auto unit = tiff.field<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
  if (stack.unit.empty() && unit == RESUNIT_INCH && resolution[0] == kPrinter) return;
  if (stack.unit.empty() && unit == RESUNIT_INCH) stack.unit = "inch";
  if (stack.unit.empty() && unit == RESUNIT_CENTIMETER) stack.unit = "cm";
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (resolution[axis] > 0) stack.spacing[axis] = 1 / static_cast<double>(resolution[axis]);
  }
}

void set_axes(VolumeInfo& info, const StackDescription& stack) {
  const LengthUnit unit = length_unit(stack.unit);
  if (!unit.note.empty()) info.notes.push_back(unit.note);
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = stack.spacing[axis] ? *stack.spacing[axis] * unit.scale : 1;
    axes.steps[axis][axis] = step;
    axes.origin[axis] = stack.origin_samples[axis] == 0 ? 0 : -stack.origin_samples[axis] * step;
    if (!stack.spacing[axis]) {
      info.notes.push_back("the spacing of axis " + std::to_string(axis) + " is not given and taken as 1");
    }
  }
  set_geometry(info.geometry, axes, info.path);
  info.geometry.unit = unit.unit;
}

void note_peculiarities(VolumeInfo& info, const TiffFile& tiff, const TiffPages& pages) {
  if (tiff.field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE) {
    info.notes.push_back("0 stands for white in this file; samples are read as stored");
  }
  const auto orientation = tiff.field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  if (orientation != ORIENTATION_TOPLEFT) {
    info.notes.push_back("the display orientation " + std::to_string(orientation) + " is not applied");
  }
  if (pages.left_out > 0) {
    info.notes.push_back(std::to_string(pages.left_out) + " pages are masks or smaller copies and are left out");
  }
}

// The pages of the first channel and frame.
std::vector<std::uint64_t> first_of(const TiffPages& pages, const StackDescription& stack, const std::string& path) {
  const auto found = static_cast<std::int64_t>(pages.offsets.size());
  if (stack.images == 0) return pages.offsets;
  if (stack.images != found) {
    bad_input(path, std::to_string(stack.images) + " pages by its description", std::to_string(found));
  }
  if (stack.slices == 0) return pages.offsets;
  std::vector<std::uint64_t> slices;
  for (std::int64_t n = 0; n < stack.slices; ++n) {
    slices.push_back(pages.offsets[static_cast<std::size_t>(n * stack.step)]);
  }
  return slices;
}

// ImageJ writes stacks beyond 4 GB as one directory, with the samples of all images behind one another.
bool is_contiguous(const TiffFile& tiff, const TiffPages& pages, const StackDescription& stack) {
  return stack.writer == StackDescription::Writer::kImageJ && stack.images > 1 && pages.offsets.size() == 1 &&
         tiff.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
}

std::unique_ptr<ByteStream> contiguous_samples(const TiffFile& tiff, const VolumeInfo& info,
                                               const StackDescription& stack) {
  const FilePtr& file = tiff.file();
  const std::uint64_t begin = TIFFGetStrileOffset(tiff.handle(), 0);
  const std::uint64_t slice = info.slice_bytes();
  std::uint64_t bytes = 0;
  const bool overflow = __builtin_mul_overflow(slice, static_cast<std::uint64_t>(stack.images), &bytes);
  if (overflow || bytes > file->size() - std::min(begin, file->size())) {
    bad_input(file->path(),
              std::to_string(stack.images) + " images of " + std::to_string(slice) + " bytes from byte " +
                  std::to_string(begin) + " on",
              "a file of " + std::to_string(file->size()));
  }
  const std::uint64_t step = slice * static_cast<std::uint64_t>(stack.step);
  const auto open = [=](std::int64_t n) {
    const std::uint64_t first = begin + static_cast<std::uint64_t>(n) * step;
    return std::make_unique<FileStream>(file, first, first + slice);
  };
  return std::make_unique<FileSequence>(info.dims[2], slice, open, [file](std::int64_t) { return file->path(); });
}

// Every file of an OME series describes the whole of it.
void describe_one_slice(StackDescription& stack, const std::string& path) {
  if (stack.writer != StackDescription::Writer::kOme) return;
  if (stack.images != stack.slices) {
    bad_input(path, "one channel and one frame in a series of files",
              std::to_string(stack.images) + " planes of " + std::to_string(stack.slices) + " slices");
  }
  stack.images = 0;
}

}  // namespace

OpenedVolume open_tiff(const FilePtr& file, bool one_of_series) {
  auto tiff = std::make_unique<TiffFile>(file);
  StackDescription stack = parse_stack_description(description_of(*tiff), file->path());
  if (one_of_series) describe_one_slice(stack, file->path());
  if (stack.writer == StackDescription::Writer::kImageJ) use_resolution(stack, *tiff);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "tiff";
  const std::uint64_t first_directory = TIFFCurrentDirOffset(tiff->handle());
  const TiffPages pages = find_tiff_pages(*tiff);
  if (TIFFSetSubDirectory(tiff->handle(), first_directory) == 0) tiff->refuse("a readable TIFF directory");
  info.type = pages.kind.type;
  info.dims = {pages.kind.width, pages.kind.height, 1};
  note_peculiarities(info, *tiff, pages);
  info.notes.insert(info.notes.end(), stack.notes.begin(), stack.notes.end());
  set_axes(info, stack);
  info.slope = stack.slope;
  info.intercept = stack.intercept;
  if (is_contiguous(*tiff, pages, stack)) {
    info.dims[2] = stack.slices > 0 ? stack.slices : stack.images;
    checked_volume_bytes(info);
    volume.swap_bytes = (TIFFIsBigEndian(tiff->handle()) != 0) != (std::endian::native == std::endian::big);
    volume.samples = contiguous_samples(*tiff, info, stack);
    return volume;
  }
  std::vector<std::uint64_t> slices = first_of(pages, stack, info.path);
  info.dims[2] = static_cast<std::int64_t>(slices.size());
  checked_volume_bytes(info);
  volume.samples = std::make_unique<TiffPageStream>(std::move(tiff), pages.kind, std::move(slices));
  return volume;
}

}  // namespace isoweave
