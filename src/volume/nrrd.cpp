// NRRD, versions 1 to 5: a text header of "field: value" lines, then the samples or the names of their files.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "volume/data_files.hpp"
#include "volume/formats.hpp"
#include "volume/geometry.hpp"
#include "volume/header_text.hpp"
#include "volume/printable.hpp"

namespace isoweave {
namespace {

constexpr double kNotSaid = std::numeric_limits<double>::quiet_NaN();

// The header as text: names of fields in lower case and without blanks.
struct NrrdFields {
  std::map<std::string, std::string> values;
  std::vector<std::string> listed;  // the lines behind "data file: LIST"
  std::size_t end = 0;              // bytes of the header, blank line included
  bool blank_line = false;

  std::string_view get(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? std::string_view() : std::string_view(found->second);
  }
};

struct NrrdAxis {
  std::int64_t size = 0;
  std::string kind;
  std::optional<Vector3> step;
  double spacing = kNotSaid;
  double least = kNotSaid;  // "axis mins"
  bool node_centred = false;
  std::string unit;
};

std::string field_name(std::string_view text) {
  std::string name = lower_case(text);
  std::erase(name, ' ');
  std::erase(name, '\t');
  return name;
}

bool is_list(std::string_view value) { return value == "LIST" || value.starts_with("LIST "); }

void read_list(NrrdFields& fields, LineReader& lines) {
  while (const auto line = lines.next()) {
    const std::string_view name = trimmed(*line);
    if (!name.empty()) fields.listed.emplace_back(name);
  }
}

NrrdFields parse_fields(const std::string& text, const std::string& path) {
  LineReader lines(text);
  const std::string_view magic = lines.next().value_or("");
  if (magic.size() != 8 || magic < "NRRD0001" || magic > "NRRD0005") {
    bad_input(path, "the magic NRRD0001 to NRRD0005", quoted(magic));
  }
  NrrdFields fields;
  while (const auto line = lines.next()) {
    if (line->empty() && lines.ended()) {
      fields.blank_line = true;
      break;
    }
    const std::size_t colon = line->find(':');
    const bool comment = line->starts_with('#');
    const bool key_and_value = line->substr(std::min(colon, line->size())).starts_with(":=");
    if (comment || key_and_value) continue;
    if (colon == std::string_view::npos) {
      bad_input(path, "header lines 'field: value'", quoted(*line));
    }
    const std::string name = field_name(line->substr(0, colon));
    const std::string_view value = trimmed(line->substr(colon + 1));
    if (!fields.values.emplace(name, value).second) bad_input(path, "each field once", "'" + name + "' twice");
    if (name == "datafile" && is_list(value)) read_list(fields, lines);
  }
  fields.end = lines.position();
  if (!fields.blank_line && text.size() >= kLargestHeader) {
    bad_input(path, "a header of at most " + std::to_string(kLargestHeader) + " bytes", "no end of it");
  }
  return fields;
}

std::int64_t integer_field(const NrrdFields& fields, const std::string& name, std::int64_t missing,
                           std::string_view path) {
  const std::string_view text = fields.get(name);
  if (text.empty()) return missing;
  const auto value = parse_integer(text);
  if (!value) bad_input(path, "a whole number as '" + name + "'", quoted(text));
  return *value;
}

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
      {SampleType::kFloat32, {"float"}},
      {SampleType::kFloat64, {"double"}}};
  const std::string text = lower_case(fields.get("type"));
  for (const Names& entry : kNames) {
    if (std::find(entry.names.begin(), entry.names.end(), text) != entry.names.end()) return entry.type;
  }
  bad_input(path, "a type of 8 to 32 bit integers, float or double", "type '" + text + "'");
}

// One word per axis where the field is there.
std::vector<std::string_view> axis_words(const NrrdFields& fields, const std::string& name, std::size_t axes,
                                         std::string_view path) {
  std::vector<std::string_view> words = words_of(fields.get(name));
  if (!words.empty() && words.size() != axes) {
    bad_input(path, std::to_string(axes) + " values in '" + name + "'", std::to_string(words.size()));
  }
  return words;
}

std::vector<double> axis_numbers(const NrrdFields& fields, const std::string& name, std::size_t axes,
                                 std::string_view path) {
  std::vector<double> numbers;
  for (const std::string_view word : axis_words(fields, name, axes, path)) {
    const auto number = parse_double(word);
    if (!number) bad_input(path, "numbers in '" + name + "'", quoted(word));
    numbers.push_back(*number);
  }
  return numbers;
}

// "(x,y,z)"; fewer coordinates are those of a plane or a line.
Vector3 parse_vector(std::string_view text, std::string_view path) {
  Vector3 vector{0, 0, 0};
  std::size_t count = 0;
  while (true) {
    const std::size_t comma = text.find(',');
    const auto number = parse_double(trimmed(text.substr(0, comma)));
    if (!number || count == 3) bad_input(path, "vectors of up to 3 numbers", quoted(text));
    vector[count++] = *number;
    if (comma == std::string_view::npos) return vector;
    text.remove_prefix(comma + 1);
  }
}

// "(1,0,0) none (0,1,0)"; a vector of NaN says none, too.
std::vector<std::optional<Vector3>> parse_vectors(std::string_view text, std::string_view path) {
  std::vector<std::optional<Vector3>> vectors;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    if (text.starts_with("none")) {
      vectors.emplace_back();
      text.remove_prefix(4);
      continue;
    }
    const std::size_t close = text.find(')');
    if (text[0] != '(' || close == std::string_view::npos) {
      bad_input(path, "vectors such as (1,0,0)", quoted(text));
    }
    const Vector3 vector = parse_vector(text.substr(1, close - 1), path);
    const bool none = std::isnan(vector[0]) && std::isnan(vector[1]) && std::isnan(vector[2]);
    vectors.push_back(none ? std::nullopt : std::optional(vector));
    text.remove_prefix(close + 1);
  }
  return vectors;
}

// The words between double quotes.
std::vector<std::string> quoted_words(std::string_view text) {
  std::vector<std::string> words;
  while (true) {
    const std::size_t open = text.find('"');
    if (open == std::string_view::npos) return words;
    const std::size_t close = text.find('"', open + 1);
    if (close == std::string_view::npos) return words;
    words.emplace_back(text.substr(open + 1, close - open - 1));
    text.remove_prefix(close + 1);
  }
}

std::vector<NrrdAxis> parse_axes(const NrrdFields& fields, const std::string& path) {
  constexpr std::int64_t kMostAxes = 16;
  const std::int64_t dimension = integer_field(fields, "dimension", 0, path);
  if (dimension < 1 || dimension > kMostAxes) {
    bad_input(path, "a dimension of 1 to 16", std::to_string(dimension));
  }
  std::vector<NrrdAxis> axes(static_cast<std::size_t>(dimension));
  const auto sizes = axis_words(fields, "sizes", axes.size(), path);
  const auto kinds = axis_words(fields, "kinds", axes.size(), path);
  const auto spacings = axis_numbers(fields, "spacings", axes.size(), path);
  const auto least = axis_numbers(fields, "axismins", axes.size(), path);
  const auto centres = axis_words(fields, fields.get("centers").empty() ? "centerings" : "centers", axes.size(), path);
  const auto units = quoted_words(fields.get("units"));
  const auto steps = parse_vectors(fields.get("spacedirections"), path);
  if (sizes.empty()) bad_input(path, "the field 'sizes'", "none");
  if (!steps.empty() && steps.size() != axes.size()) {
    bad_input(path, std::to_string(axes.size()) + " space directions", std::to_string(steps.size()));
  }
  for (std::size_t n = 0; n < axes.size(); ++n) {
    const auto size = parse_integer(sizes[n]);
    if (!size || *size < 1) bad_input(path, "sizes of at least 1", quoted(sizes[n]));
    axes[n].size = *size;
    if (!kinds.empty()) axes[n].kind = lower_case(kinds[n]);
    if (!spacings.empty()) axes[n].spacing = spacings[n];
    if (!least.empty()) axes[n].least = least[n];
    if (!centres.empty()) axes[n].node_centred = lower_case(centres[n]) == "node";
    if (!steps.empty()) axes[n].step = steps[n];
    if (units.size() == axes.size()) axes[n].unit = units[n];
  }
  return axes;
}

bool is_spatial(const NrrdAxis& axis, bool oriented) {
  if (oriented) return axis.step.has_value();
  return axis.kind.empty() || axis.kind == "domain" || axis.kind == "space" || axis.kind == "???" ||
         axis.kind == "none";
}

// The axes of the volume; any other may have one sample only, which then changes nothing about the layout.
std::vector<NrrdAxis> spatial_axes(const std::vector<NrrdAxis>& axes, std::string_view path) {
  const bool oriented = std::any_of(axes.begin(), axes.end(), [](const NrrdAxis& axis) { return axis.step; });
  std::vector<NrrdAxis> spatial;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    if (is_spatial(axes[n], oriented)) {
      spatial.push_back(axes[n]);
    } else if (axes[n].size > 1) {
      const std::string kind = axes[n].kind.empty() ? "" : " of kind '" + axes[n].kind + "'";
      bad_input(path, "one scalar per sample of a 3-D volume",
                "axis " + std::to_string(n) + kind + " with " + std::to_string(axes[n].size) + " values");
    }
  }
  while (spatial.size() > 3) {
    const auto single = std::find_if(spatial.rbegin(), spatial.rend(), [](const NrrdAxis& a) { return a.size == 1; });
    if (single == spatial.rend()) bad_input(path, "3 dimensions", std::to_string(spatial.size()));
    spatial.erase(std::next(single).base());
  }
  return spatial;
}

// Sets the space, and returns the signs that turn world coordinates of the file into it.
Vector3 set_space(VolumeInfo& info, const NrrdFields& fields) {
  const std::string space = lower_case(fields.get("space"));
  if (space.empty()) return {1, 1, 1};
  if (space == "left-posterior-superior" || space == "lps") {
    info.geometry.space = Space::kLps;
  } else if (space == "right-anterior-superior" || space == "ras") {
    info.geometry.space = Space::kRas;
  } else if (space == "left-anterior-superior" || space == "las") {
    info.geometry.space = Space::kLps;
    return {1, -1, 1};
  } else {
    info.notes.push_back("the space '" + printable(space) + "' is taken as unknown");
  }
  return {1, 1, 1};
}

void set_oriented_step(Axes& out, std::size_t n, const Vector3& step, const Vector3& signs) {
  for (std::size_t row = 0; row < 3; ++row) out.steps[n][row] = step[row] * signs[row];
}

void set_plain_step(VolumeInfo& info, Axes& out, std::size_t n, const NrrdAxis& axis) {
  double spacing = axis.spacing;
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

void set_unit(VolumeInfo& info, const NrrdFields& fields, const std::vector<NrrdAxis>& axes) {
  std::vector<std::string> units = quoted_words(fields.get("spaceunits"));
  if (units.empty()) {
    for (const NrrdAxis& axis : axes) units.push_back(axis.unit);
  }
  if (units.empty() || units[0].empty()) return;
  const bool same = std::all_of(units.begin(), units.end(), [&](const std::string& unit) { return unit == units[0]; });
  const std::string_view unit = known_unit(units[0]);
  if (same && !unit.empty()) {
    info.geometry.unit = unit;
  } else {
    info.notes.push_back("the unit '" + printable(units[0]) + "' is not one known for all axes");
  }
}

void set_axes(VolumeInfo& info, const NrrdFields& fields, const std::vector<NrrdAxis>& axes) {
  Axes out;
  const Vector3 signs = set_space(info, fields);
  for (std::size_t n = 0; n < axes.size(); ++n) {
    if (axes[n].step) {
      set_oriented_step(out, n, *axes[n].step, signs);
    } else {
      set_plain_step(info, out, n, axes[n]);
    }
  }
  // A plane image in space lacks its third axis.
  if (axes.size() == 2 && axes[0].step) out.steps[2] = normal_of(out.steps[0], out.steps[1]);
  const auto origins = parse_vectors(fields.get("spaceorigin"), info.path);
  if (!origins.empty() && origins[0]) {
    for (std::size_t row = 0; row < 3; ++row) out.origin[row] = (*origins[0])[row] * signs[row];
  }
  set_geometry(info.geometry, out, info.path);
  set_unit(info, fields, axes);
}

DataLayout layout_of(const NrrdFields& fields, std::string_view path) {
  DataLayout layout;
  const std::string encoding = lower_case(fields.get("encoding"));
  layout.compressed = encoding == "gzip" || encoding == "gz";
  if (!layout.compressed && encoding != "raw") {
    bad_input(path, "encoding '" + encoding + "' is not supported; raw and gzip are");
  }
  layout.line_skip = integer_field(fields, "lineskip", 0, path);
  layout.byte_skip = integer_field(fields, "byteskip", 0, path);
  return layout;
}

bool is_swapped(const NrrdFields& fields, SampleType type, std::string_view path) {
  const std::string endian = lower_case(fields.get("endian"));
  if (endian != "little" && endian != "big" && sample_bytes(type) > 1) {
    bad_input(path, "endian 'little' or 'big'", quoted(endian));
  }
  return (endian == "big") != (std::endian::native == std::endian::big);
}

// "name%03d.raw 1 100 1 [axes]" as pattern and numbers; nothing if it is a plain name.
std::optional<DataFiles> numbered_series(std::string_view value, const std::string& path) {
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

std::unique_ptr<ByteStream> samples_of(const FilePtr& file, const NrrdFields& fields, const DataLayout& layout,
                                       std::uint64_t bytes) {
  const std::string_view value = fields.get("datafile");
  const std::string& path = file->path();
  if (value.empty()) {
    if (!fields.blank_line) bad_input(path, "a blank line behind the header, or a data file", "neither");
    return open_samples(file, fields.end, layout, bytes);
  }
  if (is_list(value)) return open_samples(listed_files(path, fields.listed), layout, bytes, path);
  if (const auto series = numbered_series(value, path)) return open_samples(*series, layout, bytes, path);
  return open_samples(open_file(beside(path, std::string(value))), 0, layout, bytes);
}

}  // namespace

OpenedVolume open_nrrd(const FilePtr& file) {
  const NrrdFields fields = parse_fields(file->head(kLargestHeader), file->path());
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "nrrd";
  info.type = sample_type_of(fields, info.path);
  const std::vector<NrrdAxis> axes = spatial_axes(parse_axes(fields, info.path), info.path);
  info.dims = {1, 1, 1};
  for (std::size_t n = 0; n < axes.size(); ++n) info.dims[n] = axes[n].size;
  const std::uint64_t bytes = checked_volume_bytes(info);
  set_axes(info, fields, axes);
  // Text has no byte order: what is not read is said first.
  const DataLayout layout = layout_of(fields, info.path);
  volume.swap_bytes = is_swapped(fields, info.type, info.path);
  volume.samples = samples_of(file, fields, layout, bytes);
  return volume;
}

}  // namespace isoweave
