// Options that several verbs share, and the parsing of their values. Every wrong value is a std::invalid_argument
// that names the option, what was expected and what was found.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli_app.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/pipeline.hpp"
#include "isoweave/volume.hpp"
#include "progress.hpp"

namespace isoweave::cli {

[[noreturn]] void wrong_value(std::string_view option, std::string_view expected, std::string_view found);

double parse_number(std::string_view option, std::string_view text);
std::int64_t parse_count(std::string_view option, std::string_view text);                // at least 1
int parse_port(std::string_view option, std::string_view text);                          // 0 to 65535
std::uint64_t parse_bytes(std::string_view option, std::string_view text);               // "800M", "2G", "1.5Gi"
std::array<double, 3> parse_triple(std::string_view option, std::string_view text);      // "x,y,z"
std::array<std::int64_t, 3> parse_size(std::string_view option, std::string_view text);  // "N" or "WxHxD"

// Parses a length, with the option's name in its message. Refuses lengths that cannot be an error.
Length parse_error_length(std::string_view option, const std::string& text, std::string_view unit);

// Parses a text that must be one of a few words.
template <class T>
T parse_choice(std::string_view option, std::string_view text,
               std::initializer_list<std::pair<std::string_view, T>> of) {
  std::string expected;
  for (const auto& [name, value] : of) {
    if (name == text) return value;
    expected += (expected.empty() ? "" : ", ") + std::string(name);
  }
  wrong_value(option, "one of " + expected, text);
}

Quality parse_quality(std::string_view text);

// The file that a user names: "-" is standard input.
std::string input_file(const std::string& path);

// The origin of a volume: a file, or "generate:KIND:WxHxD[:TYPE[:SEED]]".
struct InputOptions {
  std::string path;
  std::string raw, spacing, origin, series, dataset, level, channel, time, slices_from, roi, step;
  std::string even_spacing;  // empty: resample, but refuse where labels are read
  bool external = true;      // a header may name other files
};

// Whether the volume comes out of standard input or another pipe, so that a later process cannot read it again.
bool is_read_once(const std::string& path);

void add_input_options(CLI::App& verb, InputOptions& input);
std::optional<GenerateOptions> generated_input(const InputOptions& input);
std::unique_ptr<SliceSource> open_input(const InputOptions& input);

// The way a run is carried out, and its output.
struct RunOptions {
  std::string threads = "all", device = "auto", schedule = "auto";
  std::string report;
  std::string progress = "auto";
  bool quiet = false;
};

int parse_threads(std::string_view text);  // 0: all
void add_run_options(CLI::App& verb, RunOptions& run);

// The part of RunControl that options decide. Throws DeviceError when the device asked for is not there.
RunControl run_control(const RunOptions& run);
ProgressMode progress_mode(const std::string& progress, bool quiet);

// Refuses outputs that would write over an input, and two outputs to one file.
void check_different(std::initializer_list<std::string_view> paths);

}  // namespace isoweave::cli
