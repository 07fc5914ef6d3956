// Volumes in legacy VTK files: structured points, and rectilinear grids whose coordinates are evenly spaced or made so.
#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/vtk/vtk_legacy_file.hpp"
#include "volume/formats/vtk/vtk_streams.hpp"
#include "volume/grid_coordinates.hpp"

namespace isoweave {
namespace {

struct LegacyHeader {
  std::map<std::string, std::string, std::less<>> fields;  // by keyword: the rest of its line
  std::array<std::optional<LegacyArray>, 3> coordinates;   // of rectilinear grids

  const std::string& get(std::string_view key, const std::string& path) const {
    const auto found = fields.find(key);
    if (found == fields.end()) bad_input(path, std::string(key) + " in the header", "none");
    return found->second;
  }
};

// "X_COORDINATES count type"
void take_coordinates(LegacyHeader& header, LegacyFile& file, const std::vector<std::string>& words) {
  const auto axis = static_cast<std::size_t>(legacy_key(words).front() - 'X');
  if (words.size() != 3) bad_input(file.path(), "a count and a type behind " + in_quotes(words[0]), "others");
  header.coordinates.at(axis) = file.array_here(words[0], words[2], 1, file.count_of(words, 1));
  file.skip(*header.coordinates.at(axis));
}

void check_kind(const LegacyFile& file, const std::vector<std::string>& words) {
  const std::string kind = words.size() < 2 ? "" : legacy_key({words[1]});
  if (kind == "STRUCTURED_POINTS" || kind == "RECTILINEAR_GRID") return;
  bad_input(file.path(), "DATASET STRUCTURED_POINTS or RECTILINEAR_GRID of a volume", in_quotes(kind));
}

// Stops at the scalars of the points, which are what is read, if nothing else is wanted.
LegacyHeader read_header(LegacyFile& file, const std::string& wanted) {
  LegacyHeader header;
  for (auto words = file.next_words(); !words.empty(); words = file.next_words()) {
    const std::string key = legacy_key(words);
    if (key == "DATASET") check_kind(file, words);
    if (key == "X_COORDINATES" || key == "Y_COORDINATES" || key == "Z_COORDINATES") {
      take_coordinates(header, file, words);
    } else if (!file.take_arrays(words)) {
      std::string& rest = header.fields[key];
      rest.clear();
      for (std::size_t n = 1; n < words.size(); ++n) rest += (n > 1 ? " " : "") + words[n];
    }
    if (wanted.empty() && !file.points.names().active.empty()) break;
  }
  return header;
}

std::array<double, 3> numbers_of(const std::string& text, std::string_view what, const std::string& path) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() != 3) bad_input(path, "3 numbers as " + std::string(what), in_quotes(text));
  std::array<double, 3> numbers{};
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const auto number = parse_double(words[n]);
    if (!number) bad_input(path, "numbers as " + std::string(what), in_quotes(words[n]));
    numbers[n] = *number;
  }
  return numbers;
}

SampleType sample_type_of(const LegacyArray& array, std::string_view path) {
  const auto type = array.type == "Bit" ? SampleType::kUint8 : parse_sample_type(lower_case(array.type));
  if (!type) bad_input(path, "numbers in the array " + in_quotes(array.name), in_quotes(array.type));
  return *type;
}

// Colours in text as their bytes.
class ColourStream final : public ByteStream {
 public:
  explicit ColourStream(std::unique_ptr<ByteStream> parts) : parts_(std::move(parts)) {}

  std::size_t read(std::span<std::byte> out) override {
    constexpr double kWhole = 255;
    std::size_t done = 0;
    double part = 0;
    for (; done < out.size() && parts_->read(std::as_writable_bytes(std::span(&part, 1))) == sizeof(part); ++done) {
      const double colour = std::round(part * kWhole);
      out[done] = static_cast<std::byte>(colour > 0 ? std::min(colour, kWhole) : 0.0);
    }
    return done;
  }

 private:
  std::unique_ptr<ByteStream> parts_;  // float64
};

// The samples as they are stored, after their number was compared with the file.
std::unique_ptr<ByteStream> open_samples(const LegacyFile& file, const LegacyArray& array, SampleType type) {
  const FilePtr& input = file.file();
  const std::uint64_t samples = array.numbers();
  const std::uint64_t left = input->size() - std::min(array.at, input->size());
  if (file.is_text()) {
    // A digit and a blank for each sample.
    check_plausible(file.path(), 2 * samples, left + 1, 1);
    auto text = std::make_unique<FileStream>(input, array.at, input->size());
    const SampleType read = array.is_colours ? SampleType::kFloat64 : type;
    auto numbers = std::make_unique<NumberStream>(std::move(text), NumberText{read, samples}, file.path());
    if (!array.is_colours) return numbers;
    return std::make_unique<ColourStream>(std::move(numbers));
  }
  constexpr std::uint64_t kBits = 8;
  const bool bits = array.type == "Bit";
  const std::uint64_t bytes = bits ? (samples + kBits - 1) / kBits : samples * sample_bytes(type);
  if (left < bytes) bad_input(file.path(), std::to_string(bytes) + " bytes of samples", std::to_string(left));
  auto stored = std::make_unique<FileStream>(input, array.at, array.at + bytes);
  if (!bits) return stored;
  return std::make_unique<BitStream>(std::move(stored), samples);
}

// The coordinates of the points along each axis.
GridCoordinates coordinates_of(const LegacyFile& file, const LegacyHeader& header, const VolumeInfo& info) {
  GridCoordinates points;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& array = header.coordinates.at(axis);
    if (!array || array->tuples != static_cast<std::uint64_t>(info.dims[axis])) {
      bad_input(info.path, std::to_string(info.dims[axis]) + " " + static_cast<char>('X' + axis) + "_COORDINATES",
                array ? std::to_string(array->tuples) : "none");
    }
    const SampleType type = file.is_text() ? SampleType::kFloat64 : sample_type_of(*array, file.path());
    const bool swap = !file.is_text() && std::endian::native == std::endian::little;
    if (array->tuples > kMostCoordinates) {
      bad_input(info.path, "at most 2^24 coordinates along an axis", std::to_string(array->tuples));
    }
    points.at(axis) = read_coordinates(*open_samples(file, *array, type), type, swap, array->tuples, info.path);
  }
  return points;
}

void set_dimensions(VolumeInfo& info, const LegacyHeader& header) {
  const std::string& text = header.get("DIMENSIONS", info.path);
  const std::vector<std::string_view> sides = words_of(text);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto side = sides.size() == 3 ? parse_integer(sides[axis]) : std::nullopt;
    if (!side || *side < 1) bad_input(info.path, "3 whole numbers as DIMENSIONS", in_quotes(text));
    info.dims[axis] = *side;
  }
}

// Samples of cells lie between the points; where there is one point only along an axis, in it.
void set_even_place(VolumeInfo& info, const LegacyHeader& header, bool cells) {
  // Version 1 had the name of the spacing.
  const bool old = !header.fields.contains("SPACING") && header.fields.contains("ASPECT_RATIO");
  const auto spacing = numbers_of(header.get(old ? "ASPECT_RATIO" : "SPACING", info.path), "SPACING", info.path);
  Axes axes;
  axes.origin = numbers_of(header.get("ORIGIN", info.path), "ORIGIN", info.path);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes.steps[axis][axis] = spacing[axis];
    if (!cells || info.dims[axis] == 1) continue;
    --info.dims[axis];
    axes.origin[axis] += spacing[axis] / 2;
  }
  set_geometry(info.geometry, axes, info.path);
}

// The grid that the slices are read on.
EvenGrid set_place(VolumeInfo& info, const LegacyHeader& header, const LegacyFile& file, bool cells,
                   const OpenOptions& options) {
  set_dimensions(info, header);
  if (legacy_key({header.get("DATASET", info.path)}) != "STRUCTURED_POINTS") {
    return place_on_grid(info, coordinates_of(file, header, info), cells, options);
  }
  set_even_place(info, header, cells);
  return {};
}

}  // namespace

bool is_vtk_legacy(std::string_view head) { return head.starts_with("# vtk DataFile Version"); }

OpenedVolume open_vtk_legacy(const FilePtr& input, const OpenOptions& options) {
  LegacyFile file(input);
  const LegacyHeader header = read_header(file, options.dataset);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = input->path();
  info.format = "vtk";
  const VtkArrayNames points = file.points.names();
  const VtkArrayNames cells = file.cells.names();
  const VtkChoice choice = choose_vtk_array(points, cells, options.dataset, info.path);
  const EvenGrid slices = set_place(info, header, file, choice.cells, options);
  note_vtk_choice(info, points, cells, choice);
  const LegacyArray& array = (choice.cells ? file.cells : file.points).all[choice.array];
  info.type = sample_type_of(array, info.path);
  const std::uint64_t samples = checked_volume_bytes(info) / sample_bytes(info.type);
  if (array.tuples != samples) {
    bad_input(info.path, std::to_string(samples) + " samples in the array " + in_quotes(array.name),
              std::to_string(array.tuples));
  }
  volume.samples = open_samples(file, array, info.type);
  volume.swap_bytes = !file.is_text() && std::endian::native == std::endian::little;
  take_even_slices(volume, slices);
  return volume;
}

}  // namespace isoweave
