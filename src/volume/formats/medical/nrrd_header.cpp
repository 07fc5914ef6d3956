#include "volume/formats/medical/nrrd_header.hpp"

#include <algorithm>
#include <cmath>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

std::string field_name(std::string_view text) {
  std::string name = lower_case(text);
  std::erase(name, ' ');
  std::erase(name, '\t');
  return name;
}

void read_list(NrrdFields& fields, LineReader& lines) {
  while (const auto line = lines.next()) {
    const std::string_view name = trimmed(*line);
    if (!name.empty()) fields.listed.emplace_back(name);
  }
}

// The words of a field, one per axis, where the field is there.
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
    if (!number) bad_input(path, "numbers in '" + name + "'", in_quotes(word));
    numbers.push_back(*number);
  }
  return numbers;
}

// "(x,y,z)" or, where the space has time, "(x,y,z,t)"; fewer coordinates are those of a plane or a line.
NrrdVector parse_vector(std::string_view text, std::string_view path) {
  NrrdVector vector;
  for (std::size_t count = 0; count <= vector.space.size(); ++count) {
    const std::size_t comma = text.find(',');
    const auto number = parse_double(trimmed(text.substr(0, comma)));
    if (!number) bad_input(path, "vectors of numbers", in_quotes(text));
    (count < vector.space.size() ? vector.space[count] : vector.time) = *number;
    if (comma == std::string_view::npos) return vector;
    text.remove_prefix(comma + 1);
  }
  bad_input(path, "vectors of up to 3 numbers, and one of time", in_quotes(text));
}

// An axis with a direction in space and none in time, or the other way round.
void take_step(NrrdAxis& axis, const std::optional<NrrdVector>& step, const std::string& path) {
  if (!step) return;
  const bool still = std::all_of(step->space.begin(), step->space.end(), [](double v) { return v == 0; });
  if (step->time == 0) {
    axis.step = step->space;
  } else if (still) {
    axis.kind = "time";
  } else {
    bad_input(path, "axes that lie in space or in time", "one that lies in both");
  }
}

}  // namespace

NrrdFields parse_nrrd_fields(const std::string& text, const std::string& path) {
  LineReader lines(text);
  const std::string_view magic = lines.next().value_or("");
  if (magic.size() != 8 || magic < "NRRD0001" || magic > "NRRD0005") {
    bad_input(path, "the magic NRRD0001 to NRRD0005", in_quotes(magic));
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
    if (!comment && key_and_value) fields.pairs.emplace(trimmed(line->substr(0, colon)), line->substr(colon + 2));
    if (comment || key_and_value) continue;
    if (colon == std::string_view::npos) {
      bad_input(path, "header lines 'field: value'", in_quotes(*line));
    }
    const std::string name = field_name(line->substr(0, colon));
    const std::string_view value = trimmed(line->substr(colon + 1));
    if (!fields.values.emplace(name, value).second) bad_input(path, "each field once", "'" + name + "' twice");
    if (name == "datafile" && is_nrrd_list(value)) read_list(fields, lines);
  }
  fields.end = lines.position();
  if (!fields.blank_line && text.size() >= kLargestHeader) {
    bad_input(path, "a header of at most " + std::to_string(kLargestHeader) + " bytes", "no end of it");
  }
  return fields;
}

bool is_nrrd_list(std::string_view value) { return value == "LIST" || value.starts_with("LIST "); }

std::string_view required_nrrd_field(const NrrdFields& fields, const std::string& name, std::string_view path) {
  const std::string_view text = fields.get(name);
  if (text.empty()) bad_input(path, "the field '" + name + "'", "none");
  return text;
}

std::int64_t nrrd_integer(const NrrdFields& fields, const std::string& name, std::int64_t missing,
                          std::string_view path) {
  const std::string_view text = fields.get(name);
  if (text.empty()) return missing;
  const auto value = parse_integer(text);
  if (!value) bad_input(path, "a whole number as '" + name + "'", in_quotes(text));
  return *value;
}

std::vector<std::optional<NrrdVector>> parse_nrrd_vectors(std::string_view text, std::string_view path) {
  std::vector<std::optional<NrrdVector>> vectors;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    if (text.starts_with("none")) {
      vectors.emplace_back();
      text.remove_prefix(4);
      continue;
    }
    const std::size_t close = text.find(')');
    if (text[0] != '(' || close == std::string_view::npos) {
      bad_input(path, "vectors such as (1,0,0)", in_quotes(text));
    }
    const NrrdVector vector = parse_vector(text.substr(1, close - 1), path);
    const bool none = std::all_of(vector.space.begin(), vector.space.end(), [](double v) { return std::isnan(v); });
    vectors.push_back(none ? std::nullopt : std::optional(vector));
    text.remove_prefix(close + 1);
  }
  return vectors;
}

std::vector<std::string> quoted_words(std::string_view text) {
  std::vector<std::string> words;
  if (text.find('"') == std::string_view::npos) {
    for (const std::string_view word : words_of(text)) words.emplace_back(word);
    return words;
  }
  while (true) {
    const std::size_t open = text.find('"');
    if (open == std::string_view::npos) return words;
    const std::size_t close = text.find('"', open + 1);
    if (close == std::string_view::npos) return words;
    words.emplace_back(text.substr(open + 1, close - open - 1));
    text.remove_prefix(close + 1);
  }
}

std::vector<NrrdAxis> parse_nrrd_axes(const NrrdFields& fields, const std::string& path) {
  constexpr std::int64_t kMostDimensions = 16;
  required_nrrd_field(fields, "dimension", path);
  const std::int64_t dimension = nrrd_integer(fields, "dimension", 0, path);
  if (dimension < 1 || dimension > kMostDimensions) {
    bad_input(path, "a dimension of 1 to 16", std::to_string(dimension));
  }
  std::vector<NrrdAxis> axes(static_cast<std::size_t>(dimension));
  const auto sizes = axis_words(fields, "sizes", axes.size(), path);
  const auto kinds = axis_words(fields, "kinds", axes.size(), path);
  const auto spacings = axis_numbers(fields, "spacings", axes.size(), path);
  const auto least = axis_numbers(fields, "axismins", axes.size(), path);
  const auto most = axis_numbers(fields, "axismaxs", axes.size(), path);
  const auto centres = axis_words(fields, fields.get("centers").empty() ? "centerings" : "centers", axes.size(), path);
  const auto units = quoted_words(fields.get("units"));
  const auto steps = parse_nrrd_vectors(fields.get("spacedirections"), path);
  required_nrrd_field(fields, "sizes", path);
  if (!steps.empty() && steps.size() != axes.size()) {
    bad_input(path, std::to_string(axes.size()) + " space directions", std::to_string(steps.size()));
  }
  for (std::size_t n = 0; n < axes.size(); ++n) {
    const auto size = parse_integer(sizes[n]);
    if (!size || *size < 1) bad_input(path, "sizes of at least 1", in_quotes(sizes[n]));
    axes[n].size = *size;
    if (!kinds.empty()) axes[n].kind = lower_case(kinds[n]);
    if (!spacings.empty()) axes[n].spacing = spacings[n];
    if (!least.empty()) axes[n].least = least[n];
    if (!most.empty()) axes[n].most = most[n];
    if (!centres.empty()) axes[n].node_centred = lower_case(centres[n]) == "node";
    if (!steps.empty()) take_step(axes[n], steps[n], path);
    if (units.size() == axes.size()) axes[n].unit = units[n];
  }
  return axes;
}

}  // namespace isoweave
