#include "report/suggestions.hpp"

#include <fmt/format.h>

#include "isoweave/generate.hpp"
#include "options/files.hpp"

namespace isoweave::cli {

Suggestions suggestions(const Histogram& histogram, const InputOptions& input, const std::atomic<bool>* stop) {
  constexpr std::size_t kClasses = 3;
  Suggestions found;
  found.otsu = otsu_threshold(histogram);
  found.three_classes = otsu_thresholds(histogram, kClasses);
  found.ct = is_hounsfield_range(histogram.min, histogram.max);
  if (const std::optional<GenerateOptions> generated = generated_input(input)) {
    found.formula = suggested_iso(generated->kind, generated->type);
  } else if (found.otsu && histogram.min >= 0 && !is_read_once(input.path)) {
    InputOptions map = input;
    map.holds_labels = true;
    found.label_map = looks_like_label_map(open_input(map), stop);
  }
  return found;
}

std::string other_surfaces(const Histogram& histogram, const InputOptions& input, const std::atomic<bool>* stop) {
  const Suggestions found = suggestions(histogram, input, stop);
  if (found.label_map)
    return input.path + ": looks like a mask or label map: --labels all makes a surface of each label";
  if (found.ct) return fmt::format("other surfaces of CT: --iso {}", presets_text());
  return "";
}

std::string presets_text() {
  std::string text;
  for (const HounsfieldPreset& preset : hounsfield_presets()) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", preset.name, preset.iso);
  }
  return text;
}

}  // namespace isoweave::cli
