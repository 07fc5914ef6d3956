#include "options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "files/from_chars.hpp"
#include "isoweave/error.hpp"
#include "output.hpp"

namespace isoweave::cli {
namespace {

constexpr std::string_view kGeneratePrefix = "generate:";
constexpr std::string_view kStandardInput = "-";
constexpr std::int64_t kMostThreads = 4096;

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// The whole text as a number, or nothing.
template <class T>
std::optional<T> to_number(std::string_view text) {
  T value{};
  const auto [end, error] = number_from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> to_finite(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const std::optional<double> value = to_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

// A whole number from 0 on; nothing for an option that is not given.
std::optional<std::int64_t> parse_index(std::string_view option, std::string_view text) {
  if (text.empty()) return std::nullopt;
  const std::optional<std::int64_t> value = to_number<std::int64_t>(text);
  if (!value || *value < 0) wrong_value(option, "a whole number from 0 on", text);
  return value;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const std::filesystem::path first = std::filesystem::weakly_canonical(a, error);
  const std::filesystem::path second = std::filesystem::weakly_canonical(b, error);
  return !error && first == second;
}

}  // namespace

void wrong_value(std::string_view option, std::string_view expected, std::string_view found) {
  throw std::invalid_argument(fmt::format("{}: expected {}, found '{}'", option, expected, found));
}

double parse_number(std::string_view option, std::string_view text) {
  const std::optional<double> value = to_finite(text);
  if (!value) wrong_value(option, "a number", text);
  return *value;
}

std::int64_t parse_count(std::string_view option, std::string_view text) {
  const std::optional<std::int64_t> value = to_number<std::int64_t>(text);
  if (!value || *value < 1) wrong_value(option, "a whole number of at least 1", text);
  return *value;
}

int parse_port(std::string_view option, std::string_view text) {
  const std::optional<std::uint16_t> port = to_number<std::uint16_t>(text);
  if (!port) wrong_value(option, "a port from 1 to 65535, or 0 for any that is free", text);
  return *port;
}

std::uint64_t parse_bytes(std::string_view option, std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 9> kUnits{{{"", 1},
                                                                       {"K", 1e3},
                                                                       {"M", 1e6},
                                                                       {"G", 1e9},
                                                                       {"T", 1e12},
                                                                       {"Ki", 1024.0},
                                                                       {"Mi", 1024.0 * 1024},
                                                                       {"Gi", 1024.0 * 1024 * 1024},
                                                                       {"Ti", 1024.0 * 1024 * 1024 * 1024}}};
  std::string_view unit = text.substr(std::min(text.find_first_not_of("0123456789."), text.size()));
  const std::optional<double> number = to_finite(text.substr(0, text.size() - unit.size()));
  if (unit.ends_with('B')) unit.remove_suffix(1);
  for (const auto& [name, bytes] : kUnits) {
    if (name == unit && number && *number * bytes >= 1 && *number * bytes < 1e18) {
      return static_cast<std::uint64_t>(*number * bytes);
    }
  }
  wrong_value(option, "an amount of memory such as 800M or 2G", text);
}

std::array<double, 3> parse_triple(std::string_view option, std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  std::array<double, 3> values{};
  if (parts.size() != values.size()) wrong_value(option, "three numbers x,y,z", text);
  for (std::size_t axis = 0; axis < values.size(); ++axis) {
    const std::optional<double> value = to_finite(parts[axis]);
    if (!value) wrong_value(option, "three numbers x,y,z", text);
    values[axis] = *value;
  }
  return values;
}

std::array<std::int64_t, 3> parse_size(std::string_view option, std::string_view text) {
  std::vector<std::string_view> parts = split(text, 'x');
  if (parts.size() == 1) parts.assign(3, parts[0]);
  std::array<std::int64_t, 3> dims{};
  if (parts.size() != dims.size()) wrong_value(option, "WxHxD with sides of at least 1", text);
  for (std::size_t axis = 0; axis < dims.size(); ++axis) {
    const std::optional<std::int64_t> side = to_number<std::int64_t>(parts[axis]);
    if (!side || *side < 1) wrong_value(option, "WxHxD with sides of at least 1", text);
    dims[axis] = *side;
  }
  return dims;
}

Length parse_error_length(std::string_view option, const std::string& text, std::string_view unit) {
  try {
    const Length length = parse_length(text, unit);
    if (std::isfinite(length.value) && length.value >= 0) return length;
  } catch (const std::invalid_argument&) {
    // The library does not know which option the text came from.
  }
  wrong_value(option, "a length of at least 0 such as 0.2vox, 0.05mm, 30um or 500nm", text);
}

Quality parse_quality(std::string_view text) {
  return parse_choice<Quality>("--quality", text,
                               {{"fast", Quality::kFast}, {"normal", Quality::kNormal}, {"fine", Quality::kFine}});
}

bool is_read_once(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  return path == kStandardInput || std::filesystem::is_fifo(status) || std::filesystem::is_socket(status);
}

void add_input_options(CLI::App& verb, InputOptions& input) {
  verb.add_option("VOLUME", input.path,
                  "Volume file, - for standard input, folder of Zarr, N5 or slices, quoted pattern such as "
                  "'slices/*.tif', or generate:KIND:WxHxD[:TYPE[:SEED]]");
  verb.add_option("--raw", input.raw,
                  "Read headerless data: WxHxD:TYPE[:big][:skip=N]; of a folder or pattern, a file for each slice");
  verb.add_option("--spacing", input.spacing, "Spacing x,y,z of the samples, instead of the file's");
  verb.add_option("--origin", input.origin, "Position x,y,z of the first sample, instead of the file's");
  verb.add_option("--series", input.series, "Which DICOM series of a folder, by its UID; none: the one without a UID");
  verb.add_option(
      "--even-spacing", input.even_spacing,
      "Slices at uneven distances (DICOM, VTK): resample (read slices at an even one, interpolated), mean (as they "
      "are, at their mean distance) or refuse");
  verb.add_option("--dataset", input.dataset,
                  "Which array of an HDF5, NPZ or VTK file or of a Zarr or N5 folder, by its path or name in it");
  verb.add_option("--level", input.level,
                  "Which of the sizes of an image in OME-Zarr, N5 or Imaris, 0 being the full one");
  verb.add_option("--channel", input.channel, "Which channel of a stack or array, from 0");
  verb.add_option("--time", input.time, "Which time or frame of a stack or array, from 0");
  verb.add_option("--slices-from", input.slices_from,
                  "Take the axis of channels or of times for that of slices: channel or time");
  verb.add_option("--roi", input.roi,
                  "Only samples I0:I1,J0:J1,K0:K1, the last ones not included; an end left out is that of the volume");
  verb.add_flag_callback(
      "--no-external", [&input] { input.external = false; },
      "Refuse a header that names other files, and links out of a folder: for files from strangers");
  verb.add_option("--step", input.step, "Make the volume smaller first: means of blocks of N x N x N samples");
}

std::string input_file(const std::string& path) { return path == kStandardInput ? "/dev/stdin" : path; }

std::optional<GenerateOptions> generated_input(const InputOptions& input) {
  if (!input.path.starts_with(kGeneratePrefix)) return std::nullopt;
  if (!input.raw.empty()) throw std::invalid_argument("--raw does not go with a generated volume");
  if (!input.origin.empty()) throw std::invalid_argument("--origin does not go with a generated volume");
  for (const auto& [option, value] : {std::pair{"--series", &input.series},
                                      {"--dataset", &input.dataset},
                                      {"--level", &input.level},
                                      {"--channel", &input.channel},
                                      {"--time", &input.time},
                                      {"--slices-from", &input.slices_from},

                                      {"--even-spacing", &input.even_spacing}}) {
    if (!value->empty()) throw std::invalid_argument(fmt::format("{} does not go with a generated volume", option));
  }
  const std::vector<std::string_view> parts = split(std::string_view(input.path).substr(kGeneratePrefix.size()), ':');
  if (parts.size() < 2 || parts.size() > 4) wrong_value("VOLUME", "generate:KIND:WxHxD[:TYPE[:SEED]]", input.path);
  GenerateOptions options;
  options.kind = parts[0];
  options.dims = parse_size("VOLUME", parts[1]);
  if (parts.size() > 2) {
    const std::optional<SampleType> type = parse_sample_type(parts[2]);
    if (!type) wrong_value("VOLUME", "a type such as uint8, int16 or float32", parts[2]);
    options.type = *type;
  }
  if (parts.size() > 3) {
    const std::optional<std::uint64_t> seed = to_number<std::uint64_t>(parts[3]);
    if (!seed) wrong_value("VOLUME", "a seed that is a whole number", parts[3]);
    options.seed = *seed;
  }
  if (!input.spacing.empty()) options.spacing = parse_triple("--spacing", input.spacing);
  return options;
}

namespace {

UnevenSlices parse_uneven(std::string_view text) {
  if (text.empty()) return OpenOptions{}.uneven_slices;
  return parse_choice<UnevenSlices>(
      "--even-spacing", text,
      {{"resample", UnevenSlices::kResample}, {"mean", UnevenSlices::kMean}, {"refuse", UnevenSlices::kRefuse}});
}

std::unique_ptr<SliceSource> open_whole(const InputOptions& input) {
  if (const std::optional<GenerateOptions> generated = generated_input(input)) return generate_volume(*generated);
  OpenOptions options;
  if (!input.raw.empty()) options.raw = parse_raw_layout(input.raw);
  if (!input.spacing.empty()) options.spacing = parse_triple("--spacing", input.spacing);
  if (!input.origin.empty()) options.origin = parse_triple("--origin", input.origin);
  options.series = input.series;
  options.dataset = input.dataset;
  options.level = parse_index("--level", input.level);
  options.channel = parse_index("--channel", input.channel);
  options.time = parse_index("--time", input.time);
  if (!input.slices_from.empty()) {
    options.slices_from = parse_choice<SliceAxis>("--slices-from", input.slices_from,
                                                  {{"channel", SliceAxis::kChannels}, {"time", SliceAxis::kTimes}});
  }
  options.uneven_slices = parse_uneven(input.even_spacing);
  options.external = input.external;
  return open_volume(input_file(input.path), options);
}

// One end of a range; `left_out` where the text is empty.
std::int64_t parse_end(std::string_view text, std::int64_t left_out, std::string_view all) {
  if (text.empty()) return left_out;
  const std::optional<std::int64_t> end = to_number<std::int64_t>(text);
  if (!end) wrong_value("--roi", "three ranges I0:I1,J0:J1,K0:K1", all);
  return *end;
}

Region parse_region(std::string_view text, const std::array<std::int64_t, 3>& dims) {
  const std::vector<std::string_view> ranges = split(text, ',');
  if (ranges.size() != dims.size()) wrong_value("--roi", "three ranges I0:I1,J0:J1,K0:K1", text);
  Region region;
  for (std::size_t axis = 0; axis < dims.size(); ++axis) {
    const std::vector<std::string_view> ends = split(ranges[axis], ':');
    if (ends.size() != 2) wrong_value("--roi", "three ranges I0:I1,J0:J1,K0:K1", text);
    region.first[axis] = parse_end(ends[0], 0, text);
    region.end[axis] = parse_end(ends[1], dims[axis], text);
  }
  return region;
}

}  // namespace

std::unique_ptr<SliceSource> open_input(const InputOptions& input) {
  std::unique_ptr<SliceSource> volume = open_whole(input);
  if (!input.roi.empty()) {
    const Region region = parse_region(input.roi, volume->info().dims);
    volume = crop_volume(std::move(volume), region);
  }
  if (!input.step.empty()) volume = downsample_volume(std::move(volume), parse_count("--step", input.step));
  return volume;
}

void add_run_options(CLI::App& verb, RunOptions& run) {
  verb.add_option("--threads", run.threads, "Threads, or all; never changes the result")->capture_default_str();
  verb.add_option("--device", run.device, "auto, cpu or cuda")->capture_default_str();
  verb.add_option("--schedule", run.schedule,
                  "auto, queue (one thread, the reference), local or rounds; never changes the result")
      ->capture_default_str();
  verb.add_option("--report", run.report, "Write what was done and measured to this JSON file");
  verb.add_option("--progress", run.progress, "auto (a bar on a terminal), always or never")->capture_default_str();
  verb.add_flag("--quiet", run.quiet, "Say nothing but errors");
}

int parse_threads(std::string_view text) {
  if (text == "all") return 0;
  const std::int64_t threads = parse_count("--threads", text);
  if (threads > kMostThreads) wrong_value("--threads", fmt::format("at most {}", kMostThreads), text);
  return static_cast<int>(threads);
}

RunControl run_control(const RunOptions& run) {
  RunControl control;
  control.threads = parse_threads(run.threads);
  control.schedule = parse_choice<Schedule>("--schedule", run.schedule,
                                            {{"auto", Schedule::kAutomatic},
                                             {"queue", Schedule::kQueue},
                                             {"local", Schedule::kLocal},
                                             {"rounds", Schedule::kRounds}});
  control.device = parse_choice<Device>("--device", run.device,
                                        {{"auto", Device::kAutomatic}, {"cpu", Device::kCpu}, {"cuda", Device::kCuda}});
  return control;
}

ProgressMode progress_mode(const std::string& progress, bool quiet) {
  const auto mode = parse_choice<ProgressMode>(
      "--progress", progress,
      {{"auto", ProgressMode::kAuto}, {"always", ProgressMode::kAlways}, {"never", ProgressMode::kNever}});
  return quiet ? ProgressMode::kNever : mode;
}

void check_different(std::initializer_list<std::string_view> paths) {
  for (const std::string_view* a = paths.begin(); a != paths.end(); ++a) {
    for (const std::string_view* b = a + 1; b != paths.end(); ++b) {
      if (!a->empty() && !b->empty() && same_file(*a, *b)) {
        throw std::invalid_argument(fmt::format("{}: would be written over {}, expected different files", *b, *a));
      }
    }
  }
}

}  // namespace isoweave::cli
