#include "options/input_volume.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "isoweave/remote.hpp"
#include "isoweave/run.hpp"
#include "options/files.hpp"
#include "options/values.hpp"
#include "signals.hpp"

namespace isoweave::cli {
namespace {

constexpr std::string_view kGeneratePrefix = "generate:";

// A whole number from 0 on; nothing for an option that is not given.
std::optional<std::int64_t> parse_index(std::string_view option, std::string_view text) {
  if (text.empty()) return std::nullopt;
  const std::optional<std::int64_t> value = to_number<std::int64_t>(text);
  if (!value || *value < 0) wrong_value(option, "a whole number from 0 on", text);
  return value;
}

UnevenSlices parse_uneven(std::string_view text) {
  if (text.empty()) return OpenOptions{}.uneven_slices;
  return parse_choice<UnevenSlices>(
      "--even-spacing", text,
      {{"resample", UnevenSlices::kResample}, {"mean", UnevenSlices::kMean}, {"refuse", UnevenSlices::kRefuse}});
}

// The layout, with its type in any spelling. What is wrong with it is said by the option's name.
RawLayout parse_raw(const std::string& text) {
  std::string plain;
  for (const std::string_view part : split(text, ':')) plain += (plain.empty() ? "" : ":") + type_name(part);
  try {
    return parse_raw_layout(plain);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("--raw: ") + error.what());
  }
}

std::unique_ptr<SliceSource> open_whole(const InputOptions& input) {
  if (const std::optional<GenerateOptions> generated = generated_input(input)) return generate_volume(*generated);
  OpenOptions options;
  if (!input.raw.empty()) options.raw = parse_raw(input.raw);
  if (!input.spacing.empty()) options.spacing = parse_spacing("--spacing", input.spacing);
  if (!input.origin.empty()) options.origin = parse_triple("--origin", input.origin);
  options.unit = input.unit;
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
  if (!is_url(input.path)) return open_volume(input_file(input.path), options);
  RemoteOptions remote = remote_options();
  remote.stop = borrow(stop_flag());
  return open_remote_volume(input.secret_url.empty() ? input.path : input.secret_url, options, remote);
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

void set_place(InputOptions& input, const std::string& given) {
  input.path = shown_url(given);
  input.secret_url = input.path == given ? "" : given;
}

void add_input_options(CLI::App& verb, InputOptions& input) {
  verb.add_option_function<std::string>(
      "VOLUME", [&input](const std::string& given) { set_place(input, given); },
      "Volume file, - for standard input, folder of Zarr, N5, precomputed or slices, URL of the first three (http://, "
      "https://, s3:// or gs://), quoted pattern such as 'slices/*.tif', or generate:KIND:WxHxD[:TYPE[:SEED]]");
  verb.add_option("--raw", input.raw,
                  "Read headerless data: WxHxD:TYPE[:big][:skip=N]; of a folder or pattern, a file for each slice");
  verb.add_option("--spacing", input.spacing,
                  "Spacing of the samples, or one number for all axes, instead of the file's");
  verb.add_option("--origin", input.origin, "Position x,y,z of the first sample, instead of the file's");
  verb.add_option("--unit", input.unit,
                  "Unit of the spacing: mm, um, nm, m, cm, ...; without it the file's, and mm where the file has none");
  verb.add_option("--series", input.series, "Which DICOM series of a folder, by its UID; none: the one without a UID");
  verb.add_option(
      "--even-spacing", input.even_spacing,
      "Slices at uneven distances (DICOM, VTK): resample (read slices at an even one, interpolated), mean (as they "
      "are, at their mean distance) or refuse");
  verb.add_option("--dataset", input.dataset,
                  "Which array of an HDF5, NPZ or VTK file or of a Zarr or N5 folder, by its path or name in it");
  verb.add_option("--level", input.level,
                  "Resolution level of OME-Zarr, N5, precomputed or Imaris; 0 is the full size");
  verb.add_option("--channel", input.channel, "Which channel of a stack or array, from 0");
  verb.add_option("--time", input.time, "Which time or frame of a stack or array, from 0");
  verb.add_option("--slices-from", input.slices_from,
                  "Take the axis of channels or of times for that of slices: channel or time");
  verb.add_option("--roi", input.roi,
                  "Only samples I0:I1,J0:J1,K0:K1, the last ones not included; an end left out is that of the volume");
  verb.add_flag_callback(
      "--no-external", [&input] { input.external = false; },
      "Refuse a header that names other files, and links out of a folder: for files from strangers");
  verb.add_option("--step", input.step,
                  "Make the volume smaller first: means of blocks of N x N x N samples, with --labels the most "
                  "frequent label of each");
}

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
                                      {"--even-spacing", &input.even_spacing},
                                      {"--unit", &input.unit}}) {
    if (!value->empty()) throw std::invalid_argument(fmt::format("{} does not go with a generated volume", option));
  }
  const std::vector<std::string_view> parts = split(std::string_view(input.path).substr(kGeneratePrefix.size()), ':');
  if (parts.size() < 2 || parts.size() > 4) wrong_value("VOLUME", "generate:KIND:WxHxD[:TYPE[:SEED]]", input.path);
  GenerateOptions options;
  options.kind = parts[0];
  options.dims = parse_size("VOLUME", parts[1]);
  if (parts.size() > 2) {
    const std::optional<SampleType> type = parse_sample_type(type_name(parts[2]));
    if (!type) wrong_value("VOLUME", "a type such as uint8, int16 or float32", parts[2]);
    options.type = *type;
  }
  if (parts.size() > 3) {
    const std::optional<std::uint64_t> seed = to_number<std::uint64_t>(parts[3]);
    if (!seed) wrong_value("VOLUME", "a seed that is a whole number", parts[3]);
    options.seed = *seed;
  }
  if (!input.spacing.empty()) options.spacing = parse_spacing("--spacing", input.spacing);
  return options;
}

std::unique_ptr<SliceSource> open_input(const InputOptions& input) {
  std::unique_ptr<SliceSource> volume = open_whole(input);
  if (!input.roi.empty()) {
    const Region region = parse_region(input.roi, volume->info().dims);
    volume = crop_volume(std::move(volume), region);
  }
  if (input.step.empty()) return volume;
  const std::int64_t step = parse_count("--step", input.step, "2");
  return input.holds_labels ? thin_label_map(std::move(volume), step) : downsample_volume(std::move(volume), step);
}

}  // namespace isoweave::cli
