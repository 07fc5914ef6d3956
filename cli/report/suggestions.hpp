// Iso-values that a volume suggests.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "isoweave/histogram.hpp"
#include "options/input_volume.hpp"

namespace isoweave::cli {

struct Suggestions {
  std::optional<double> otsu, formula;
  std::vector<double> three_classes;  // the two thresholds between them
  bool ct = false;                    // Hounsfield units: bone, skin and lung
  bool label_map = false;
};

// Opens the volume once more where that may be done, to look for labels.
Suggestions suggestions(const Histogram& histogram, const InputOptions& input, const std::atomic<bool>* stop);

// One line about surfaces beside Otsu's, for --iso auto; empty where there is nothing to say.
std::string other_surfaces(const Histogram& histogram, const InputOptions& input, const std::atomic<bool>* stop);

// "bone (226), skin (-300), lung (-500)".
std::string presets_text();

}  // namespace isoweave::cli
