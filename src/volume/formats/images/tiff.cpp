// TIFF and BigTIFF stacks through libtiff: one directory per slice, in strips or tiles, of any compression that libtiff
// decodes.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/length_units.hpp"
#include "volume/axes.hpp"
#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/images/stack_description.hpp"
#include "volume/formats/images/tiff_file.hpp"
#include "volume/formats/images/tiff_pages.hpp"
#include "volume/formats/images/tiff_stream.hpp"
#include "volume/half_floats.hpp"

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
  // The unit belongs to the resolution, and is the inch where a file gives neither.
  if (!(resolution[0] > 0)) return;
  if (stack.units[0].empty() && unit == RESUNIT_INCH && resolution[0] == kPrinter) return;
  for (std::string& own : stack.units) {
    if (own.empty() && unit == RESUNIT_INCH) own = "inch";
    if (own.empty() && unit == RESUNIT_CENTIMETER) own = "cm";
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (resolution[axis] > 0) stack.spacing[axis] = 1 / static_cast<double>(resolution[axis]);
  }
}

// ImageJ leaves out a unit that is the pixel, also where another axis has one.
void name_pixels(StackDescription& stack) {
  const bool any =
      std::any_of(stack.units.begin(), stack.units.end(), [](const std::string& unit) { return !unit.empty(); });
  for (std::string& unit : stack.units) {
    if (any && unit.empty()) unit = "pixel";
  }
}

void set_axes(OpenedVolume& volume, const StackDescription& stack) {
  VolumeInfo& info = volume.info;
  std::array<std::optional<std::string>, 3> texts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (stack.spacing[axis]) texts[axis] = stack.units[axis];
  }
  const CommonUnit unit = common_unit(texts);
  take_unit(volume, unit);
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = stack.spacing[axis] ? *stack.spacing[axis] * unit.scale[axis] : 1;
    axes.steps[axis][axis] = step;
    axes.origin[axis] = stack.origin_samples[axis] == 0 ? 0 : -stack.origin_samples[axis] * step;
    if (!stack.spacing[axis]) {
      info.notes.push_back("the spacing of axis " + std::to_string(axis) + " is not given and taken as 1");
    }
  }
  set_geometry(info.geometry, axes, info.path);
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

// Number of the page, or of the image in a contiguous stack, that is slice k: first + k * step.
struct PageNumbers {
  std::int64_t first = 0;
  std::int64_t step = 1;
  std::int64_t count = 1;

  std::int64_t of(std::int64_t k) const { return first + k * step; }
};

// Chooses the slices among all images.
PageNumbers choose_slices(VolumeInfo& info, const StackDescription& stack, std::int64_t images,
                          const OpenOptions& options) {
  std::vector<ArrayAxis> axes = stack.axes;
  if (axes.empty()) axes = {{images, "z"}};
  axes.push_back({info.dims[1], "y"});
  axes.push_back({info.dims[0], "x"});
  const AxisChoice choice = choose_axes(axes, options, info.path);
  info.notes.insert(info.notes.end(), choice.notes.begin(), choice.notes.end());
  info.part = choice.part;
  PageNumbers numbers;
  std::int64_t step = 1;
  for (std::size_t n = axes.size() - 2; n-- > 0; step *= axes[n].size) {
    numbers.first += choice.at[n] * step;
    if (n != choice.axis[2]) continue;
    numbers.step = step;
    numbers.count = axes[n].size;
  }
  return numbers;
}

std::vector<std::uint64_t> pages_of(const TiffPages& pages, const PageNumbers& numbers) {
  std::vector<std::uint64_t> slices;
  for (std::int64_t k = 0; k < numbers.count; ++k) {
    slices.push_back(pages.offsets[static_cast<std::size_t>(numbers.of(k))]);
  }
  return slices;
}

// A shape is a remark of the program that wrote the file, which others may keep with pages of their own.
void check_images(StackDescription& stack, std::int64_t found, VolumeInfo& info) {
  if (stack.images == 0 || stack.images == found) return;
  if (stack.writer != StackDescription::Writer::kTifffile) {
    bad_input(info.path, std::to_string(stack.images) + " pages by its description",
              std::to_string(found) + (stack.names_others ? " (the others are in the files that it names)" : ""));
  }
  info.notes.push_back("the shape in its description is of " + std::to_string(stack.images) + " pages; all " +
                       std::to_string(found) + " that there are are read as slices");
  stack.axes.clear();
}

// Puts the pages into the order of the planes that they hold.
void follow_runs(TiffPages& pages, const StackDescription& stack, VolumeInfo& info) {
  if (stack.images == 0) return;
  if (stack.names_others && stack.runs.empty()) {
    info.notes.emplace_back("the files that its description names are others: pages are read one after another");
  }
  if (stack.runs.empty()) return;
  if (stack.names_others) {
    bad_input(info.path, "all planes in this file", "some in files that its description names");
  }
  const std::vector<std::size_t> places = places_of_planes(stack.runs, pages.numbers, info.path);
  if (std::is_sorted(places.begin(), places.end())) return;
  info.notes.emplace_back(
      "pages are in the order of the planes in its description (TiffData), not in that of the file");
  std::vector<std::uint64_t> offsets;
  offsets.reserve(places.size());
  for (const std::size_t place : places) offsets.push_back(pages.offsets[place]);
  pages.offsets = std::move(offsets);
}

// ImageJ writes stacks beyond 4 GB as one directory, with the samples of all images behind one another.
bool is_contiguous(const TiffFile& tiff, const TiffPages& pages, const StackDescription& stack) {
  return stack.writer == StackDescription::Writer::kImageJ && stack.images > 1 && pages.offsets.size() == 1 &&
         tiff.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
}

std::unique_ptr<ByteStream> contiguous_samples(const TiffFile& tiff, const VolumeInfo& info, std::int64_t images,
                                               const PageNumbers& numbers) {
  const FilePtr& file = tiff.file();
  const std::uint64_t begin = TIFFGetStrileOffset(tiff.handle(), 0);
  const std::uint64_t slice = info.slice_bytes();
  std::uint64_t bytes = 0;
  const bool overflow = __builtin_mul_overflow(slice, static_cast<std::uint64_t>(images), &bytes);
  if (overflow || bytes > file->size() - std::min(begin, file->size())) {
    bad_input(file->path(),
              std::to_string(images) + " images of " + std::to_string(slice) + " bytes from byte " +
                  std::to_string(begin) + " on",
              "a file of " + std::to_string(file->size()));
  }
  const auto open = [=](std::int64_t k) {
    const std::uint64_t first = begin + static_cast<std::uint64_t>(numbers.of(k)) * slice;
    return std::make_unique<FileStream>(file, first, first + slice);
  };
  return std::make_unique<FileSequence>(info.dims[2], slice, open, [file](std::int64_t) { return file->path(); });
}

// Every file of an OME series describes the whole of it. Returns which slice the file has, where that is said.
std::optional<std::int64_t> describe_one_slice(StackDescription& stack, const std::string& path) {
  if (stack.writer != StackDescription::Writer::kOme) return std::nullopt;
  const auto slices =
      std::find_if(stack.axes.begin(), stack.axes.end(), [](const ArrayAxis& a) { return a.name == "z"; });
  if (stack.images != slices->size) {
    bad_input(path, "one channel and one frame in a series of files",
              std::to_string(stack.images) + " planes of " + std::to_string(slices->size) + " slices");
  }
  stack.images = 0;
  stack.axes.clear();
  return stack.runs.size() == 1 ? std::optional(stack.runs.front().plane) : std::nullopt;
}

}  // namespace

OpenedVolume open_tiff(const FilePtr& file, bool one_of_series, const OpenOptions& options) {
  auto tiff = std::make_unique<TiffFile>(file);
  StackDescription stack = parse_stack_description(description_of(*tiff), file->path());
  OpenedVolume volume;
  if (one_of_series) volume.place_in_series = describe_one_slice(stack, file->path());
  if (stack.writer == StackDescription::Writer::kImageJ) {
    use_resolution(stack, *tiff);
    name_pixels(stack);
  }
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "tiff";
  const std::uint64_t first_directory = TIFFCurrentDirOffset(tiff->handle());
  TiffPages pages = find_tiff_pages(*tiff);
  if (TIFFSetSubDirectory(tiff->handle(), first_directory) == 0) tiff->refuse("a readable TIFF directory");
  info.type = pages.kind.type.type;
  info.dims = {pages.kind.width, pages.kind.height, 1};
  note_peculiarities(info, *tiff, pages);
  const bool contiguous = is_contiguous(*tiff, pages, stack);
  const auto found = static_cast<std::int64_t>(pages.offsets.size());
  if (!contiguous) check_images(stack, found, info);
  follow_runs(pages, stack, info);
  const std::int64_t images = contiguous ? stack.images : found;
  const PageNumbers numbers = choose_slices(info, stack, images, options);
  info.dims[2] = numbers.count;
  checked_volume_bytes(info);
  set_axes(volume, stack);
  info.slope = stack.slope;
  info.intercept = stack.intercept;
  if (contiguous) {
    volume.swap_bytes = (TIFFIsBigEndian(tiff->handle()) != 0) != (std::endian::native == std::endian::big);
    volume.samples = contiguous_samples(*tiff, info, images, numbers);
  } else {
    volume.gaps = std::make_shared<Gaps>();
    auto samples = std::make_unique<TiffPageStream>(std::move(tiff), pages.kind, pages_of(pages, numbers), volume.gaps);
    volume.held_bytes = samples->held_bytes();
    volume.samples = std::move(samples);
  }
  if (pages.kind.type.is_half) read_halves(volume);
  return volume;
}

}  // namespace isoweave
