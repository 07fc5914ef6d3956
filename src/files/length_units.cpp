#include "files/length_units.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

struct Spellings {
  LengthUnit unit;
  std::initializer_list<std::string_view> names;  // in lower case, without the s of a plural
};

constexpr double kMillimetresPerInch = 25.4;

// All names of a unit of length that headers use. Units that numbers are kept in come first.
const std::initializer_list<Spellings>& known_spellings() {
  static const std::initializer_list<Spellings> kSpellings{
      {{1, "m"}, {"m", "meter", "metre"}},
      {{1, "mm"}, {"mm", "millimeter", "millimetre"}},
      {{1, "um"}, {"um", "micron", "micrometer", "micrometre"}},
      {{1, "nm"}, {"nm", "nanometer", "nanometre"}},
      {{1000, "m"}, {"km", "kilometer", "kilometre"}},
      {{100, "mm"}, {"dm", "decimeter", "decimetre"}},
      {{10, "mm"}, {"cm", "centimeter", "centimetre"}},
      {{0.1, "nm"}, {"\xc3\xa5", "\xe2\x84\xab", "angstrom", "\xc3\xa5ngstr\xc3\xb6m", "ang"}},
      {{0.001, "nm"}, {"pm", "picometer", "picometre"}},
      {{1, "in"}, {"in", "inch", "inche"}},
      {{12, "in"}, {"ft", "foot", "feet"}},
      {{0.0254, "mm"}, {"thou"}},
  };
  return kSpellings;
}

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

// Lower case, with the micro sign, the Greek letter, their escapes and the byte of Latin-1 as 'u'.
std::string plain_spelling(std::string_view text) {
  const std::string_view inner = trimmed(text);
  std::string plain = lower_case(inner);
  for (const std::string_view micro : {"\xc2\xb5", "\xce\xbc", "\\u00b5", "\\u03bc", "&micro;"}) {
    replace_all(plain, micro, "u");
  }
  if (plain == "\xb5m" || plain == "\xb5") plain.replace(0, 1, "u");
  // Angstroms: the capital letter, its escape, the byte of Latin-1.
  for (const std::string_view ring : {"\xc3\x85", "\\u00c5", "\\u212b"}) replace_all(plain, ring, "\xc3\xa5");
  if (plain == "\xc5") plain = "\xc3\xa5";
  return plain;
}

// Nanometres are whole numbers for all units, so that the ratio of two is rounded once.
std::optional<double> nanometres(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
      {{"m", 1e9}, {"mm", 1e6}, {"um", 1e3}, {"nm", 1}, {"in", 25.4e6}}};
  for (const auto& [known, length] : kUnits) {
    if (known == name) return length;
  }
  return std::nullopt;
}

std::string listed(const std::array<std::optional<std::string>, 3>& texts) {
  std::string list;
  for (const std::optional<std::string>& text : texts) {
    if (text) list += (list.empty() ? "" : ", ") + in_quotes(*text);
  }
  return list;
}

bool is_pixel(std::string_view text) {
  const std::string name = lower_case(trimmed(text));
  return name == "pixel" || name == "pixels" || name == "px" || name == "voxel" || name == "voxels";
}

}  // namespace

std::optional<LengthUnit> find_length_unit(std::string_view text) {
  // OME's megametre differs from the millimetre by its capital only.
  if (trimmed(text) == "Mm") return std::nullopt;
  const std::string plain = plain_spelling(text);
  for (const Spellings& entry : known_spellings()) {
    for (const std::string_view name : entry.names) {
      const bool plural = name.size() > 2 && plain.size() == name.size() + 1 && plain.back() == 's';
      if (plain == name || (plural && plain.starts_with(name))) return entry.unit;
    }
  }
  return std::nullopt;
}

std::optional<LengthUnit> find_metric_unit(std::string_view text) {
  const std::optional<LengthUnit> unit = find_length_unit(text);
  if (unit && unit->name == "in") return LengthUnit{unit->scale * kMillimetresPerInch, "mm"};
  return unit;
}

std::optional<double> unit_in(const LengthUnit& unit, std::string_view other) {
  const std::optional<double> from = nanometres(unit.name), to = nanometres(other);
  if (!from || !to) return std::nullopt;
  return unit.scale * *from / *to;
}

std::optional<double> unit_in(std::string_view unit, std::string_view other) {
  return unit_in(LengthUnit{1, unit}, other);
}

CommonUnit common_unit(const std::array<std::optional<std::string>, 3>& texts) {
  CommonUnit common;
  std::array<std::optional<LengthUnit>, 3> units;
  std::optional<std::string> unknown;
  bool differ = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!texts[axis] || trimmed(*texts[axis]).empty()) continue;
    units[axis] = find_metric_unit(*texts[axis]);
    if (units[axis] && common.unit.empty()) common.unit = units[axis]->name;
    if (units[axis]) continue;
    differ = differ || (unknown && *unknown != *texts[axis]);
    unknown = texts[axis];
  }
  if (unknown && (differ || !common.unit.empty())) {
    common.conflict = listed(texts);
    // The caller's spacing is in the unit of the first axis, if that has one.
    if (texts[0] && !units[0]) common.unit.clear();
    return common;
  }
  if (unknown && !is_pixel(*unknown)) {
    common.notes.push_back("the unit " + in_quotes(*unknown) + " is no length that is known and is left out");
  }
  for (std::size_t axis = 0; axis < 3 && !common.unit.empty(); ++axis) {
    if (!texts[axis]) continue;
    if (units[axis]) common.scale[axis] = unit_in(*units[axis], common.unit).value_or(1);
    if (!units[axis]) {
      common.notes.push_back("the unit of axis " + std::to_string(axis) + " is not given and taken as '" + common.unit +
                             "'");
    } else if (units[axis]->name != common.unit) {
      common.notes.push_back("axis " + std::to_string(axis) + " is in " + in_quotes(trimmed(*texts[axis])) +
                             " and given in '" + common.unit + "'");
    }
  }
  return common;
}

}  // namespace isoweave
