#include "volume/formats/images/stack_description.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "files/xml_tag.hpp"

namespace isoweave {
namespace {

using Fields = std::map<std::string, std::string, std::less<>>;

std::int64_t count_of(std::string_view text, std::string_view what, std::string_view path) {
  if (text.empty()) return 1;
  const auto count = parse_integer(trimmed(text));
  constexpr std::int64_t kMost = std::int64_t{1} << 40;
  if (!count || *count < 1 || *count > kMost) {
    bad_input(path, "a count of at least 1 as " + std::string(what), in_quotes(text));
  }
  return *count;
}

// A number as a length. Nothing where it cannot be one: programs write 0, negative steps and NaN where they know none.
std::optional<double> length_of(std::string_view text) {
  const auto value = parse_double(trimmed(text));
  if (!value || !std::isfinite(*value) || *value == 0) return std::nullopt;
  return std::abs(*value);
}

std::int64_t product(std::int64_t a, std::int64_t b, std::string_view path) {
  std::int64_t result = 0;
  if (__builtin_mul_overflow(a, b, &result)) bad_input(path, "fewer than 2^63 images", "counts whose product is more");
  return result;
}

Fields key_lines(std::string_view text) {
  Fields fields;
  LineReader lines(text);
  while (const auto line = lines.next()) {
    const std::size_t equals = line->find('=');
    if (equals != std::string_view::npos) fields.emplace(line->substr(0, equals), line->substr(equals + 1));
  }
  return fields;
}

std::string_view value_of(const Fields& fields, std::string_view key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string_view() : std::string_view(found->second);
}

// A straight-line calibration; ImageJ keeps signed 16-bit samples as unsigned ones with one.
void set_calibration(StackDescription& stack, const Fields& fields) {
  if (value_of(fields, "cf") != "0") return;
  const auto intercept = parse_double(trimmed(value_of(fields, "c0")));
  const auto slope = parse_double(trimmed(value_of(fields, "c1")));
  if (!intercept || !slope || !std::isfinite(*intercept) || !std::isfinite(*slope) || *slope == 0) return;
  stack.slope = *slope;
  stack.intercept = *intercept;
}

// Axes of channels, slices and frames where the counts say that there are any but slices.
void set_imagej_axes(StackDescription& stack, const Fields& fields, std::string_view path) {
  const std::int64_t channels = count_of(value_of(fields, "channels"), "channels", path);
  const std::int64_t frames = count_of(value_of(fields, "frames"), "frames", path);
  const std::string_view slices = value_of(fields, "slices");
  const std::string_view images = value_of(fields, "images");
  stack.images = images.empty() ? 0 : count_of(images, "images", path);
  if (slices.empty() && channels == 1 && frames == 1) return;
  const std::int64_t depth = count_of(slices, "slices", path);
  const std::int64_t all = product(product(channels, frames, path), depth, path);
  if (!images.empty() && all != stack.images) {
    bad_input(path, std::to_string(all) + " images by the counts of channels, slices and frames",
              std::to_string(stack.images));
  }
  stack.images = all;
  // Channels change fastest, then slices, then frames.
  stack.axes = {{frames, "time"}, {depth, "z"}, {channels, "channel"}};
}

StackDescription parse_imagej(std::string_view text, std::string_view path) {
  const Fields fields = key_lines(text);
  StackDescription stack;
  stack.writer = StackDescription::Writer::kImageJ;
  set_imagej_axes(stack, fields, path);
  stack.spacing[2] = length_of(value_of(fields, "spacing"));
  stack.units.fill(std::string(trimmed(value_of(fields, "unit"))));
  constexpr std::array<std::string_view, 3> kUnits{"xunit", "yunit", "zunit"};
  constexpr std::array<std::string_view, 3> kOrigins{"xorigin", "yorigin", "zorigin"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view own = trimmed(value_of(fields, kUnits[axis]));
    if (!own.empty()) stack.units[axis] = own;
    const auto sample = parse_double(trimmed(value_of(fields, kOrigins[axis])));
    if (sample && std::isfinite(*sample)) stack.origin_samples[axis] = *sample;
  }
  set_calibration(stack, fields);
  return stack;
}

// Axes from the slowest to the fastest, of a DimensionOrder that begins with the fastest.
void set_ome_axes(StackDescription& stack, std::string_view tag, std::string_view path) {
  const std::string order = xml_attribute(tag, "DimensionOrder");
  const std::array<std::pair<char, ArrayAxis>, 3> axes{
      {{'Z', {count_of(xml_attribute(tag, "SizeZ"), "SizeZ", path), "z"}},
       {'C', {count_of(xml_attribute(tag, "SizeC"), "SizeC", path), "channel"}},
       {'T', {count_of(xml_attribute(tag, "SizeT"), "SizeT", path), "time"}}}};
  stack.images = 1;
  for (std::size_t n = order.size() == 5 && order.starts_with("XY") ? order.size() : 0; n > 2; --n) {
    for (const auto& [letter, axis] : axes) {
      if (letter != order[n - 1]) continue;
      stack.axes.push_back(axis);
      stack.images = product(stack.images, axis.size, path);
    }
  }
  const auto named = [&stack](std::string_view name) {
    return std::any_of(stack.axes.begin(), stack.axes.end(), [name](const ArrayAxis& a) { return a.name == name; });
  };
  if (!named("z") || !named("channel") || !named("time")) {
    bad_input(path, "a DimensionOrder such as XYZCT", in_quotes(order));
  }
}

// The Pixels element of the image in this file; a unit that is not given is the micrometre.
StackDescription parse_ome(std::string_view text, const std::string& path) {
  StackDescription stack;
  stack.writer = StackDescription::Writer::kOme;
  const OmeImage image = find_ome_image(text, path);
  const std::string_view tag = image.pixels;
  set_ome_axes(stack, tag, path);
  stack.runs = plane_runs(image, stack.axes, path);
  stack.names_others = !image.elsewhere.empty();
  constexpr std::array<const char*, 3> kSizes{"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    stack.spacing[axis] = length_of(xml_attribute(tag, kSizes[axis]));
    const std::string unit = xml_attribute(tag, std::string(kSizes[axis]) + "Unit");
    stack.units[axis] = unit.empty() ? "um" : unit;
  }
  return stack;
}

// The whole numbers of a list behind a key in JSON; nothing for anything else.
std::optional<std::vector<std::int64_t>> json_numbers(std::string_view text, std::string_view key) {
  const std::size_t begin = text.find("\"" + std::string(key) + "\": [");
  const std::size_t open = begin == std::string_view::npos ? begin : text.find('[', begin);
  const std::size_t close = open == std::string_view::npos ? open : text.find(']', open);
  if (close == std::string_view::npos) return std::nullopt;
  std::string list(text.substr(open + 1, close - open - 1));
  std::replace(list.begin(), list.end(), ',', ' ');
  std::vector<std::int64_t> numbers;
  for (const std::string_view word : words_of(std::string_view(list))) {
    const auto number = parse_integer(word);
    if (!number || *number < 1) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

// Letters for the axes of a shape; where there are none, the last ones are those of most stacks.
std::string shape_letters(std::string_view text, std::size_t axes) {
  constexpr std::string_view kKey = "\"axes\": \"";
  const std::size_t begin = text.find(kKey);
  if (begin != std::string_view::npos) {
    const std::string_view letters =
        text.substr(begin + kKey.size(), text.find('"', begin + kKey.size()) - begin - kKey.size());
    if (letters.size() == axes) return std::string(letters);
  }
  constexpr std::string_view kUsual = "TCZYX";
  const std::string_view known = kUsual.substr(kUsual.size() - std::min(kUsual.size(), axes));
  return std::string(axes - known.size(), '?') + std::string(known);
}

// The description that tifffile writes of an array: {"shape": [2, 20, 24, 28], "axes": "CZYX"}.
StackDescription parse_tifffile(std::string_view text, std::string_view path) {
  StackDescription stack;
  const auto shape = json_numbers(text, "shape");
  if (!shape || shape->size() < 3 || shape->size() > kMostAxes) return stack;
  const std::string letters = shape_letters(text, shape->size());
  if (!letters.ends_with("YX")) return stack;
  stack.writer = StackDescription::Writer::kTifffile;
  stack.images = 1;
  const bool has_z = letters.find('Z') != std::string::npos;
  for (std::size_t n = 0; n + 2 < letters.size(); ++n) {
    ArrayAxis axis{(*shape)[n], std::string(1, letters[n])};
    if (letters[n] == 'C') axis.name = "channel";
    if (letters[n] == 'T') axis.name = "time";
    // The images along an axis that is only called a sequence are slices.
    if (letters[n] == 'Z' || (!has_z && (letters[n] == 'I' || letters[n] == 'Q'))) axis.name = "z";
    stack.images = product(stack.images, axis.size, path);
    stack.axes.push_back(std::move(axis));
  }
  return stack;
}

}  // namespace

StackDescription parse_stack_description(std::string_view text, const std::string& path) {
  if (text.starts_with("ImageJ=")) return parse_imagej(text, path);
  if (text.find("<OME") != std::string_view::npos) return parse_ome(text, path);
  if (text.starts_with("{\"")) return parse_tifffile(text, path);
  return {};
}

}  // namespace isoweave
