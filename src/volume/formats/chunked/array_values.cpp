#include "volume/formats/chunked/array_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// A finite number; nothing where there is no such attribute, or with a note for any other.
std::optional<double> number_in(const ArrayAttributes& attributes, const std::string& name,
                                std::vector<std::string>& notes) {
  if (!attributes.has(name)) return std::nullopt;
  const std::optional<std::vector<double>> list = attributes.numbers(name);
  if (list && list->size() == 1 && std::isfinite(list->front())) return list->front();
  notes.push_back("attribute " + name + " is no finite number and is left out");
  return std::nullopt;
}

// The numbers or texts of an attribute for notes; empty where all are NaN, which samples may be anyway.
std::string text_of_missing(const ArrayAttributes& attributes, const std::string& name) {
  // xarray keeps numbers of Zarr 3 as the base64 of their bytes: NaN of 32 and of 64 bits.
  static constexpr std::array<std::string_view, 3> kNan{"NaN", "AADAfw==", "AAAAAAAA+H8="};
  std::string text;
  const auto add = [&text](const std::string& entry) { text += (text.empty() ? "" : ", ") + entry; };
  if (const auto numbers = attributes.numbers(name)) {
    for (const double number : *numbers) {
      if (!std::isnan(number)) add(number_text(number));
    }
    return text;
  }
  const std::vector<std::string> texts = attributes.texts(name);
  for (const std::string& entry : texts) {
    if (std::find(kNan.begin(), kNan.end(), entry) == kNan.end()) add(in_quotes(entry));
  }
  return texts.empty() ? "of another kind" : text;
}

// Attributes that say which samples are none.
void note_missing(VolumeInfo& info, const ArrayAttributes& attributes) {
  for (const char* const name : {"_FillValue", "missing_value", "valid_range", "valid_min", "valid_max"}) {
    const std::string text = attributes.has(name) ? text_of_missing(attributes, name) : std::string();
    if (text.empty()) continue;
    info.notes.push_back("attribute " + std::string(name) + " (" + text +
                         ") is not applied: samples that stand for no value are read as any other");
  }
}

// Integers that are of the other sign than their type says.
void note_sign(VolumeInfo& info, const ArrayAttributes& attributes) {
  const std::vector<std::string> texts = attributes.texts("_Unsigned");
  if (texts.size() != 1 || !is_integer(info.type)) return;
  const std::string_view type = sample_type_name(info.type);
  if ((lower_case(texts[0]) == "true") == type.starts_with('u')) return;
  info.notes.push_back("attribute _Unsigned is not applied: samples are read as " + std::string(type));
}

}  // namespace

ArrayScaling scaling_of_attributes(const ArrayAttributes& attributes) {
  ArrayScaling scaling;
  scaling.slope = number_in(attributes, "scale_factor", scaling.notes).value_or(1);
  scaling.intercept = number_in(attributes, "add_offset", scaling.notes).value_or(0);
  if (scaling.slope == 0) {
    scaling.slope = 1;
    scaling.notes.emplace_back("attribute scale_factor is 0 and is left out");
  }
  return scaling;
}

void take_values(VolumeInfo& info, const ArrayAttributes& attributes) {
  const ArrayScaling scaling = scaling_of_attributes(attributes);
  info.slope = scaling.slope;
  info.intercept = scaling.intercept;
  info.notes.insert(info.notes.end(), scaling.notes.begin(), scaling.notes.end());
  note_sign(info, attributes);
  note_missing(info, attributes);
}

}  // namespace isoweave
