#include "volume/stack_description.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "volume/geometry.hpp"
#include "volume/header_text.hpp"
#include "volume/input_file.hpp"
#include "volume/printable.hpp"
#include "volume/xml_tag.hpp"

namespace isoweave {
namespace {

using Fields = std::map<std::string, std::string, std::less<>>;

std::int64_t count_of(std::string_view text, std::string_view what, std::string_view path) {
  if (text.empty()) return 1;
  const auto count = parse_integer(trimmed(text));
  constexpr std::int64_t kMost = std::int64_t{1} << 40;
  if (!count || *count < 1 || *count > kMost) {
    bad_input(path, "a count of at least 1 as " + std::string(what), quoted(text));
  }
  return *count;
}

// A length that can be one; programs write 0, negative steps and NaN where they know none.
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

void note_first_only(StackDescription& stack, std::int64_t channels, std::int64_t frames) {
  if (channels > 1) stack.notes.push_back("the first of " + std::to_string(channels) + " channels is read");
  if (frames > 1) stack.notes.push_back("the first of " + std::to_string(frames) + " frames is read");
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

// ImageJ writes its text in ASCII, with the micro sign escaped.
std::string unescaped(std::string_view text) {
  constexpr std::string_view kMicro = "\\u00B5";
  std::string result(trimmed(text));
  const std::size_t at = result.find(kMicro);
  if (at != std::string::npos) result.replace(at, kMicro.size(), "\xc2\xb5");
  // The Latin-1 byte of older versions.
  if (result == "\xb5m") result = "um";
  return result;
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

// Channels change fastest, then slices, then frames.
StackDescription parse_imagej(std::string_view text, std::string_view path) {
  const Fields fields = key_lines(text);
  StackDescription stack;
  stack.writer = StackDescription::Writer::kImageJ;
  const std::int64_t channels = count_of(value_of(fields, "channels"), "channels", path);
  const std::int64_t frames = count_of(value_of(fields, "frames"), "frames", path);
  const std::string_view slices = value_of(fields, "slices");
  const std::string_view images = value_of(fields, "images");
  stack.images = images.empty() ? 0 : count_of(images, "images", path);
  if (!slices.empty() || channels > 1 || frames > 1) {
    stack.slices = count_of(slices, "slices", path);
    const std::int64_t all = product(product(channels, frames, path), stack.slices, path);
    if (!images.empty() && all != stack.images) {
      bad_input(path, std::to_string(all) + " images by the counts of channels, slices and frames",
                std::to_string(stack.images));
    }
    stack.images = all;
  }
  stack.step = channels;
  note_first_only(stack, channels, frames);
  stack.spacing[2] = length_of(value_of(fields, "spacing"));
  stack.unit = unescaped(value_of(fields, "unit"));
  constexpr std::array<std::string_view, 3> kOrigins{"xorigin", "yorigin", "zorigin"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto sample = parse_double(trimmed(value_of(fields, kOrigins[axis])));
    if (sample && std::isfinite(*sample)) stack.origin_samples[axis] = *sample;
  }
  set_calibration(stack, fields);
  return stack;
}

// The first Pixels element of an OME-XML text; a unit that is not given is the micrometre.
StackDescription parse_ome(std::string_view text, std::string_view path) {
  StackDescription stack;
  stack.writer = StackDescription::Writer::kOme;
  const std::size_t begin = text.find("<Pixels ");
  if (begin == std::string_view::npos) bad_input(path, "Pixels in its OME description", "none");
  const std::string_view tag = text.substr(begin, text.find('>', begin) - begin);
  const std::int64_t channels = count_of(xml_attribute(tag, "SizeC"), "SizeC", path);
  const std::int64_t frames = count_of(xml_attribute(tag, "SizeT"), "SizeT", path);
  stack.slices = count_of(xml_attribute(tag, "SizeZ"), "SizeZ", path);
  stack.images = product(product(channels, frames, path), stack.slices, path);
  const std::string order = xml_attribute(tag, "DimensionOrder");
  const std::size_t z = order.find('Z');
  if (order.size() != 5 || !order.starts_with("XY") || z == std::string::npos) {
    bad_input(path, "a DimensionOrder such as XYZCT", quoted(order));
  }
  // What changes before z lies between two slices.
  if (order.find('C') < z) stack.step = product(stack.step, channels, path);
  if (order.find('T') < z) stack.step = product(stack.step, frames, path);
  note_first_only(stack, channels, frames);
  constexpr std::array<const char*, 3> kSizes{"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
  const std::string unit = xml_attribute(tag, "PhysicalSizeXUnit");
  stack.unit = unit.empty() ? "um" : unit;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    stack.spacing[axis] = length_of(xml_attribute(tag, kSizes[axis]));
    const std::string other = xml_attribute(tag, std::string(kSizes[axis]) + "Unit");
    if (stack.spacing[axis] && other != unit) {
      bad_input(path, "one unit for the physical sizes of all axes", quoted(unit) + " and " + quoted(other));
    }
  }
  return stack;
}

}  // namespace

StackDescription parse_stack_description(std::string_view text, std::string_view path) {
  if (text.starts_with("ImageJ=")) return parse_imagej(text, path);
  if (text.find("<OME") != std::string_view::npos) return parse_ome(text, path);
  return {};
}

LengthUnit length_unit(std::string_view text) {
  const std::string name = lower_case(text);
  if (name.empty() || name == "pixel" || name == "pixels") return {};
  if (const std::string_view known = known_unit(name); !known.empty()) return {1, std::string(known), {}};
  if (name == "cm" || name == "centimeter") return {10, "mm", {}};
  if (name == "angstrom") return {0.1, "nm", {}};
  if (name == "inch" || name == "in") return {25.4, "mm", {}};
  return {1, {}, "the unit " + quoted(text) + " is none of m, mm, um, nm and is left out"};
}

}  // namespace isoweave
