// NRRD, versions 1 to 5: a text header of "field: value" lines, then the samples or the names of their files.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/external_files.hpp"
#include "files/header_text.hpp"
#include "files/length_units.hpp"
#include "files/part_file.hpp"
#include "files/quoted.hpp"
#include "volume/axes.hpp"
#include "volume/data_files.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/medical/nrrd_header.hpp"
#include "volume/formats/medical/segmentation.hpp"
#include "volume/picked_stream.hpp"

namespace isoweave {
namespace {

SampleType sample_type_of(const NrrdFields& fields, std::string_view path) {
  struct Names {
    SampleType type;
    std::vector<std::string_view> names;
  };
  static const std::vector<Names> kNames{
      {SampleType::kInt8, {"signed char", "int8", "int8_t"}},
      {SampleType::kUint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {SampleType::kInt16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {SampleType::kUint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {SampleType::kInt32, {"int", "signed int", "int32", "int32_t"}},
      {SampleType::kUint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {SampleType::kInt64,
       {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"}},
      {SampleType::kUint64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {SampleType::kFloat32, {"float"}},
      {SampleType::kFloat64, {"double"}}};
  const std::string text = lower_case(required_nrrd_field(fields, "type", path));
  for (const Names& entry : kNames) {
    if (std::find(entry.names.begin(), entry.names.end(), text) != entry.names.end()) return entry.type;
  }
  bad_input(path, "a type of 8 to 64 bit integers, float or double", "type '" + text + "'");
}

bool is_spatial(const NrrdAxis& axis, bool oriented) {
  if (oriented) return axis.step.has_value();
  return axis.kind.empty() || axis.kind == "domain" || axis.kind == "space" || axis.kind == "???" ||
         axis.kind == "none";
}

// Finds the spatial axes. Of more than three axes, those of one sample are left out; then the last one is time.
std::vector<bool> find_spatial(std::vector<NrrdAxis>& axes, std::string_view path) {
  const bool oriented = std::any_of(axes.begin(), axes.end(), [](const NrrdAxis& axis) { return axis.step; });
  std::vector<bool> spatial;
  spatial.reserve(axes.size());
  for (const NrrdAxis& axis : axes) spatial.push_back(is_spatial(axis, oriented));
  auto surplus = std::count(spatial.begin(), spatial.end(), true) - 3;
  for (std::size_t n = axes.size(); n-- > 0 && surplus > 0;) {
    if (!spatial[n] || axes[n].size > 1) continue;
    spatial[n] = false;
    --surplus;
  }
  if (surplus > 1) bad_input(path, "at most 4 dimensions", std::to_string(3 + surplus));
  if (surplus == 1) {
    const std::size_t last =
        axes.size() - 1 -
        static_cast<std::size_t>(std::find(spatial.rbegin(), spatial.rend(), true) - spatial.rbegin());
    spatial[last] = false;
    axes[last].kind = "time";
  }
  return spatial;
}

// Parts of one sample: vectors, colours. They are no choice of volumes, unless the caller chooses.
void refuse_parts(const NrrdAxis& axis, std::size_t n, const OpenOptions& options, std::string_view path) {
  if (options.channel || options.slices_from == SliceAxis::kChannels || axis.size == 1) return;
  if (axis.kind.empty() || axis.kind == "list" || axis.kind == "none" || axis.kind == "???") return;
  bad_input(path, "one scalar per sample of a 3-D volume",
            "axis " + std::to_string(n) + " of kind '" + axis.kind + "' with " + std::to_string(axis.size) +
                " values (--channel chooses one)");
}

// The axes of the file from the slowest to the fastest, by the names that choose_axes knows.
std::vector<ArrayAxis> named_axes(std::vector<NrrdAxis>& axes, const OpenOptions& options, std::string_view path) {
  const std::vector<bool> spatial = find_spatial(axes, path);
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  std::vector<ArrayAxis> named;
  std::size_t used = 0;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    ArrayAxis axis{axes[n].size, {}};
    if (spatial[n]) {
      axis.name = kNames.at(used++);
    } else if (axes[n].kind == "time") {
      axis.name = "time";
    } else if (axis.size > 1) {
      refuse_parts(axes[n], n, options, path);
      axis.name = "channel";
    }
    named.push_back(axis);
  }
  // A line is a plane of one row.
  if (used == 1) named.push_back({1, "y"});
  std::reverse(named.begin(), named.end());
  return named;
}

// The axes of i, j and k, as far as there are any.
std::vector<NrrdAxis> chosen_axes(const std::vector<NrrdAxis>& axes, const std::vector<ArrayAxis>& named,
                                  const AxisChoice& choice) {
  std::vector<NrrdAxis> chosen;
  for (const std::size_t axis : choice.place) {
    if (axis == kNoAxis) continue;
    const std::size_t n = named.size() - 1 - axis;
    chosen.push_back(n < axes.size() ? axes[n] : NrrdAxis{});
  }
  return chosen;
}

// Sets the space, and returns the signs that turn world coordinates of the file into it.
Vector3 set_space(VolumeInfo& info, const NrrdFields& fields) {
  constexpr std::string_view kTime = "-time";
  std::string space = lower_case(fields.get("space"));
  if (space.ends_with(kTime)) space.resize(space.size() - kTime.size());
  if (space.empty()) return {1, 1, 1};
  if (space == "left-posterior-superior" || space == "lps" || space == "lpst") {
    info.geometry.space = Space::kLps;
  } else if (space == "right-anterior-superior" || space == "ras" || space == "rast") {
    info.geometry.space = Space::kRas;
  } else if (space == "left-anterior-superior" || space == "las" || space == "last") {
    info.geometry.space = Space::kLps;
    return {1, -1, 1};
  } else {
    info.notes.push_back("the space " + in_quotes(space) + " is taken as unknown");
  }
  return {1, 1, 1};
}

// The distance of samples between the least and the most coordinate of an axis; NaN where these are not given.
double spacing_by_ends(const NrrdAxis& axis) {
  const auto gaps = static_cast<double>(axis.node_centred ? axis.size - 1 : axis.size);
  return gaps > 0 ? (axis.most - axis.least) / gaps : std::numeric_limits<double>::quiet_NaN();
}

void set_plain_step(VolumeInfo& info, Axes& out, std::size_t n, const NrrdAxis& axis) {
  double spacing = std::isnan(axis.spacing) ? spacing_by_ends(axis) : axis.spacing;
  if (std::isnan(spacing)) {
    spacing = 1;
    const std::string note = "the spacing is not given for every axis and taken as 1 there";
    if (info.notes.empty() || info.notes.back() != note) info.notes.push_back(note);
  }
  out.steps[n] = {0, 0, 0};
  out.steps[n][n] = spacing;
  // "axis mins" is where the first sample, or the first half of its cell, begins.
  if (!std::isnan(axis.least)) out.origin[n] = axis.least + (axis.node_centred ? 0 : 0.5 * spacing);
}

void note_other_spacing(VolumeInfo& info, std::size_t n, const NrrdAxis& axis) {
  constexpr double kRounding = 1e-3;
  const double taken = length_of(*axis.step);
  if (std::isnan(axis.spacing) || std::abs(std::abs(axis.spacing) - taken) <= kRounding * taken) return;
  info.notes.push_back("the spacing of axis " + std::to_string(n) + " is " + rounded_text(taken) +
                       " by its space direction, which is taken, and " + rounded_text(axis.spacing) + " by spacings");
}

// Units of the world where axes have directions in it, else those of the axes, which are then those of the world.
CommonUnit unit_of(const NrrdFields& fields, const std::vector<NrrdAxis>& axes) {
  const bool oriented = axes[0].step.has_value();
  const std::vector<std::string> world = quoted_words(fields.get("spaceunits"));
  const bool own = std::any_of(axes.begin(), axes.end(), [](const NrrdAxis& axis) { return !axis.unit.empty(); });
  std::array<std::optional<std::string>, 3> texts;
  for (std::size_t n = 0; n < 3; ++n) {
    if (!world.empty() && (oriented || !own)) {
      if (n < world.size() && (oriented || n < axes.size())) texts[n] = world[n];
    } else if (n < axes.size()) {
      texts[n] = axes[n].unit;
    }
  }
  CommonUnit unit = common_unit(texts);
  const bool same = unit.scale[1] == unit.scale[0] && unit.scale[2] == unit.scale[0];
  // Units of axes that do not go along the world's say nothing of the world.
  if (oriented && world.empty() && !same) unit.conflict = "units of axes, not of the space, that differ";
  return unit;
}

void apply_unit(Axes& out, const CommonUnit& unit) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (Vector3& step : out.steps) step[row] *= unit.scale[row];
    out.origin[row] *= unit.scale[row];
  }
}

// `axes`: those of i, j and k.
void set_axes(OpenedVolume& volume, const NrrdFields& fields, const std::vector<NrrdAxis>& axes) {
  VolumeInfo& info = volume.info;
  Axes out;
  const Vector3 signs = set_space(info, fields);
  for (std::size_t n = 0; n < axes.size(); ++n) {
    if (!axes[n].step) {
      set_plain_step(info, out, n, axes[n]);
      continue;
    }
    note_other_spacing(info, n, axes[n]);
    for (std::size_t row = 0; row < 3; ++row) out.steps[n][row] = (*axes[n].step)[row] * signs[row];
  }
  // A plane image in space lacks its third axis, and so do slices that are kept as something else.
  const bool plane = axes[0].step && axes[1].step && (axes.size() == 2 || !axes[2].step);
  if (plane) out.steps[2] = normal_of(out.steps[0], out.steps[1]);
  const auto origins = parse_nrrd_vectors(fields.get("spaceorigin"), info.path);
  if (!origins.empty() && origins[0]) {
    for (std::size_t row = 0; row < 3; ++row) out.origin[row] = origins[0]->space[row] * signs[row];
  }
  const CommonUnit unit = unit_of(fields, axes);
  apply_unit(out, unit);
  set_geometry(info.geometry, out, info.path, axes[0].step ? " by the space directions" : "");
  take_unit(volume, unit);
}

DataLayout layout_of(const NrrdFields& fields, SampleType type, std::string_view path) {
  DataLayout layout;
  layout.type = type;
  const std::string encoding = lower_case(required_nrrd_field(fields, "encoding", path));
  if (encoding == "gzip" || encoding == "gz") {
    layout.encoding = DataLayout::Encoding::kDeflate;
  } else if (encoding == "ascii" || encoding == "text" || encoding == "txt") {
    layout.encoding = DataLayout::Encoding::kNumbers;
  } else if (encoding == "hex") {
    layout.encoding = DataLayout::Encoding::kHex;
  } else if (encoding != "raw") {
    bad_input(path, "encoding raw, gzip, ascii or hex", in_quotes(encoding));
  }
  layout.line_skip = nrrd_integer(fields, "lineskip", 0, path);
  layout.byte_skip = nrrd_integer(fields, "byteskip", 0, path);
  return layout;
}

bool is_swapped(const NrrdFields& fields, SampleType type, std::string_view path) {
  const std::string endian = lower_case(fields.get("endian"));
  if (endian != "little" && endian != "big" && sample_bytes(type) > 1) {
    bad_input(path, "endian 'little' or 'big'", in_quotes(endian));
  }
  return (endian == "big") != (std::endian::native == std::endian::big);
}

// "name%03d.raw 1 100 1 [axes]" as pattern and numbers; nothing if it is a plain name.
std::optional<DataFiles> nrrd_series(std::string_view value, const std::string& path) {
  std::vector<std::string_view> words = words_of(value);
  std::vector<std::int64_t> numbers;
  while (words.size() > 1 && numbers.size() < 4) {
    const auto number = parse_integer(words.back());
    if (!number) break;
    numbers.insert(numbers.begin(), *number);
    words.pop_back();
  }
  const auto used = static_cast<std::size_t>(words.back().data() + words.back().size() - value.data());
  const std::string pattern(value.substr(0, used));
  if (numbers.size() < 3 || pattern.find('%') == std::string::npos) return std::nullopt;
  return numbered_files(path, pattern, numbers);
}

std::unique_ptr<ByteStream> samples_of(VolumeInfo& info, const FilePtr& file, const NrrdFields& fields,
                                       const DataLayout& layout, std::uint64_t bytes) {
  const std::string_view value = fields.get("datafile");
  const std::string& path = file->path();
  if (value.empty()) {
    if (!fields.blank_line) bad_input(path, "a blank line behind the header, or a data file", "neither");
    return open_only_file(info, file, fields.end, layout, bytes);
  }
  if (is_nrrd_list(value)) return open_samples(info, listed_files(path, fields.listed), layout, bytes);
  if (const auto series = nrrd_series(value, path)) return open_samples(info, *series, layout, bytes);
  return open_only_file(info, open_part(path, "its samples in", beside(path, std::string(value))), 0, layout, bytes);
}

// The layers of a segmentation are a list, also where they are called a vector.
void name_layers(std::vector<NrrdAxis>& axes, const NrrdFields& fields) {
  if (!fields.pairs.contains("Segment0_Name") && !fields.pairs.contains("Segment0_ID")) return;
  for (NrrdAxis& axis : axes) {
    if (axis.kind == "vector") axis.kind = "list";
  }
}

std::int64_t layers_of(const std::vector<ArrayAxis>& axes) {
  const auto found =
      std::find_if(axes.begin(), axes.end(), [](const ArrayAxis& axis) { return axis.name == "channel"; });
  return found == axes.end() ? 1 : found->size;
}

}  // namespace

OpenedVolume open_nrrd(const FilePtr& file, const OpenOptions& options) {
  const NrrdFields fields = parse_nrrd_fields(file->head(kLargestHeader), file->path());
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "nrrd";
  info.type = sample_type_of(fields, info.path);
  std::vector<NrrdAxis> axes = parse_nrrd_axes(fields, info.path);
  name_layers(axes, fields);
  const std::vector<ArrayAxis> named = named_axes(axes, options, info.path);
  const AxisChoice choice = choose_axes(named, options, info.path);
  info.dims = choice.dims(named);
  info.part = choice.part;
  info.notes = choice.notes;
  info.labels = segments_of(fields.pairs, layers_of(named), info.path);
  checked_volume_bytes(info);
  set_axes(volume, fields, chosen_axes(axes, named, choice));
  const DataLayout layout = layout_of(fields, info.type, info.path);
  // Text has no byte order.
  const bool text = layout.encoding == DataLayout::Encoding::kNumbers;
  volume.swap_bytes = !text && is_swapped(fields, info.type, info.path);
  const std::size_t each = sample_bytes(info.type);
  if (const std::string_view other = fields.get("datafile"); !other.empty()) check_external(options, info.path, other);
  auto samples = samples_of(info, file, fields, layout, checked_bytes_of(named, each, info.path));
  volume.samples = pick_volume(std::move(samples), named, choice, each, info.path);
  return volume;
}

}  // namespace isoweave
