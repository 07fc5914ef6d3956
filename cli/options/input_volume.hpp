// The volume that mesh and info read.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "isoweave/generate.hpp"
#include "isoweave/volume.hpp"
#include "options/cli_app.hpp"

namespace isoweave::cli {

// The origin of a volume: a file, a URL, or "generate:KIND:WxHxD[:TYPE[:SEED]]".
struct InputOptions {
  std::string path;  // as reports and saved states show it: without what a URL says of its user
  std::string raw, spacing, origin, series, dataset, level, channel, time, slices_from, roi, step;
  std::string even_spacing;   // empty: resample, but refuse where labels are read
  bool external = true;       // a header may name other files
  std::string unit;           // empty: that of the file
  std::string secret_url{};   // the whole URL, where `path` is not all of it
  bool holds_labels = false;  // --step takes the most frequent label of each block
};

// Takes a path as it was given.
void set_place(InputOptions& input, const std::string& given);

void add_input_options(CLI::App& verb, InputOptions& input);
std::optional<GenerateOptions> generated_input(const InputOptions& input);
std::unique_ptr<SliceSource> open_input(const InputOptions& input);

}  // namespace isoweave::cli
