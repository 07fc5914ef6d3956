// isoweave info: the facts of a volume, from one pass over it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "isoweave/histogram.hpp"
#include "isoweave/output_file.hpp"
#include "isoweave/printable.hpp"
#include "options/files.hpp"
#include "options/input_volume.hpp"
#include "page/page.hpp"
#include "page/range_page.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "report/suggestions.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kInfoExamples = R"(
Examples:
  isoweave info scan.nii.gz
  isoweave info foot.raw --raw 256x256x256:uint8
  isoweave info scan.nii.gz --json
  isoweave info scan.nii.gz --isos --html isos.html)";

constexpr std::size_t kParts = 16;
constexpr std::size_t kBarLength = 40;

struct InfoArguments {
  InputOptions input;
  PageOptions page;
  bool json = false, isos = false, no_clobber = false;
};

// The lengths of the box of the samples.
std::array<double, 3> extent(const VolumeInfo& info) {
  std::array<double, 3> lengths{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lengths[axis] = info.geometry.spacing[axis] * static_cast<double>(info.dims[axis]);
  }
  return lengths;
}

Json isos_json(const CrossingCounts& crossings) {
  return {{"first", crossings.first}, {"step", crossings.step}, {"vertices", crossings.counts}};
}

Json info_json(const VolumeInfo& info, const Histogram& histogram, const Suggestions& suggested,
               const std::string& path) {
  Json input = volume_json(info, path);
  add_range(input, histogram.min, histogram.max, histogram.nan);
  if (histogram.whole) {
    input["min"] = label_json((*histogram.whole)[0]);
    input["max"] = label_json((*histogram.whole)[1]);
  }
  input["infinite"] = histogram.infinite;
  input["labels"] = Json::array();
  for (const LabelName& label : info.labels) {
    input["labels"].push_back({{"label", label_json(label.label)}, {"name", label.name}, {"layer", label.layer}});
  }
  Json iso = Json::object();
  iso["otsu"] = suggested.otsu ? Json(*suggested.otsu) : Json(nullptr);
  if (suggested.formula) iso["formula"] = *suggested.formula;
  iso["three_classes"] = suggested.three_classes;
  iso["presets"] = Json::object();
  for (const HounsfieldPreset& preset : hounsfield_presets()) {
    if (suggested.ct) iso["presets"][std::string(preset.name)] = preset.iso;
  }
  input["extent"] = extent(info);
  input["label_map"] = suggested.label_map;
  return {{"version", ISOWEAVE_VERSION},
          {"input", input},
          {"histogram", {{"low", input["min"]}, {"high", input["max"]}, {"counts", coarser_bins(histogram, kParts)}}},
          {"suggested_iso", iso}};
}

double part_of_range(const Histogram& histogram) { return histogram.max / kParts - histogram.min / kParts; }

double largest_value(const Histogram& histogram) { return std::max(std::abs(histogram.min), std::abs(histogram.max)); }

// Why a range has no parts; empty where it has some.
std::string why_no_parts(const Histogram& histogram) {
  if (histogram.empty()) return "no sample is finite";
  const bool differ = histogram.whole ? (*histogram.whole)[0] != (*histogram.whole)[1] : histogram.min != histogram.max;
  if (!differ) return histogram.nan + histogram.infinite > 0 ? "all finite samples are equal" : "all samples are equal";
  const double largest = largest_value(histogram);
  const double distance = largest - std::nextafter(largest, 0.0);  // of numbers that differ by their last digits
  return part_of_range(histogram) < distance ? "the samples differ by their last digits" : "";
}

// Values of a range as text, with so many digits that a part of the range is told from the next one: 6, or more where
// the range is narrow beside its values.
class ValueText {
 public:
  explicit ValueText(const Histogram& histogram) {
    const double digits = std::log10(largest_value(histogram) / part_of_range(histogram));
    if (digits > 0) digits_ = static_cast<int>(std::clamp(std::ceil(digits) + 3, kUsual, kMost));
  }

  std::string operator()(double value) const { return fmt::format("{:.{}g}", value, digits_); }

  // To the right of a column that is wide enough for all values of the range.
  std::string in_column(double value) const {
    constexpr int kSignPointAndExponent = 6;
    return fmt::format("{:>{}.{}g}", value, digits_ + kSignPointAndExponent, digits_);
  }

 private:
  static constexpr double kUsual = 6, kMost = 17;
  int digits_ = 6;
};

// The histogram. The length of a bar is the square root of its count: else air would hide everything.
std::string histogram_text(const Histogram& histogram, const ValueText& value_text) {
  const std::string reason = why_no_parts(histogram);
  if (!reason.empty()) return fmt::format("histogram  none: {}\n", reason);
  const std::vector<std::uint64_t> counts = coarser_bins(histogram, kParts);
  const auto most = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  std::string text = "histogram  (bars: square roots of the counts)\n";
  for (std::size_t n = 0; n < kParts; ++n) {
    const double length = std::sqrt(static_cast<double>(counts[n]) / most) * static_cast<double>(kBarLength);
    // Not from the difference of the ends, which may be no number.
    const double part = static_cast<double>(n) / kParts;
    text +=
        fmt::format("  from {} {:>16} {}\n", value_text.in_column(histogram.min * (1 - part) + histogram.max * part),
                    grouped(counts[n]), std::string(static_cast<std::size_t>(std::ceil(length)), '#'));
  }
  return text;
}

// The triangles of surfaces at some of the iso-values. Bars are in proportion: the largest of a part of the range
// stands for it.
std::string isos_text(const CrossingCounts& crossings, const ValueText& value_text) {
  constexpr std::size_t kLines = 32;
  if (crossings.counts.empty()) return fmt::format("isos       none: {}\n", why_no_parts(crossings.histogram));
  const auto most = static_cast<double>(std::ranges::max(crossings.counts));
  const std::size_t lines = std::min(kLines, crossings.counts.size());
  std::string text = "isos       (about so many triangles of the closed surface; the most of each part of the range)\n";
  for (std::size_t n = 0; n < lines; ++n) {
    const auto begin = crossings.counts.begin() + static_cast<std::ptrdiff_t>(n * crossings.counts.size() / lines);
    const auto end = crossings.counts.begin() + static_cast<std::ptrdiff_t>((n + 1) * crossings.counts.size() / lines);
    const auto largest = std::max_element(begin, end);
    const auto place = static_cast<double>(largest - crossings.counts.begin());
    // By halves, as the width of the range may be no number.
    const double iso = 2 * (crossings.first / 2 + crossings.step / 2 * place);
    const double length = static_cast<double>(*largest) / std::max(most, 1.0) * static_cast<double>(kBarLength);
    text += fmt::format("  iso {} {:>16} {}\n", value_text.in_column(iso), grouped(2 * *largest),
                        std::string(static_cast<std::size_t>(std::ceil(length)), '#'));
  }
  return text;
}

std::string axes_text(const Geometry& geometry) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += fmt::format("({:.6g} {:.6g} {:.6g}) ", geometry.direction[axis], geometry.direction[3 + axis],
                        geometry.direction[6 + axis]);
  }
  return text + "space " + std::string(space_name(geometry.space));
}

std::string range_text(const Histogram& histogram) {
  if (histogram.empty()) return "no finite value";
  if (histogram.whole) return fmt::format("{} to {}", (*histogram.whole)[0].text(), (*histogram.whole)[1].text());
  return fmt::format("{} to {}", histogram.min, histogram.max);
}

std::string info_text(const VolumeInfo& info, const Histogram& histogram, const Suggestions& suggested,
                      const std::string& path) {
  const Geometry& geometry = info.geometry;
  const auto slices = static_cast<std::uint64_t>(info.dims[2]);
  const std::uint64_t samples = static_cast<std::uint64_t>(info.slice_samples()) * slices;
  std::string text = fmt::format("volume     {}, {}\n", printable(path), info.format);
  if (!info.part.empty()) text += fmt::format("part       {}\n", printable(info.part));
  text += fmt::format("size       {} x {} x {} {}, {} samples, {}\n", info.dims[0], info.dims[1], info.dims[2],
                      sample_type_name(info.type), grouped(samples), byte_text(info.slice_bytes() * slices));
  text += fmt::format("spacing    {:.6g} x {:.6g} x {:.6g} {}\n", geometry.spacing[0], geometry.spacing[1],
                      geometry.spacing[2],
                      geometry.unit.empty() ? "mm (the file names no unit; see --unit)" : printable(geometry.unit));
  text += fmt::format("extent     {}\n", size_text(extent(info), geometry.unit));
  text +=
      fmt::format("origin     {:.6g}, {:.6g}, {:.6g}\n", geometry.origin[0], geometry.origin[1], geometry.origin[2]);
  text += fmt::format("axes       {}\n", axes_text(geometry));
  if (info.slope != 1 || info.intercept != 0) {
    text += fmt::format("scaling    value = {} * stored + {}\n", info.slope, info.intercept);
  }
  text += "values     " + range_text(histogram);
  text += fmt::format(", {} NaN, {} infinite\n", grouped(histogram.nan), grouped(histogram.infinite));
  if (suggested.formula) text += fmt::format("suggested  --iso {} (the formula's surface)\n", *suggested.formula);
  const ValueText value_text(histogram);
  if (suggested.otsu) text += fmt::format("suggested  --iso {} (Otsu's threshold)\n", value_text(*suggested.otsu));
  if (suggested.three_classes.size() == 2) {
    text += fmt::format("           --iso {} or {} (three classes)\n", value_text(suggested.three_classes[0]),
                        value_text(suggested.three_classes[1]));
  }
  if (suggested.ct) text += fmt::format("           --iso {} (tissues of CT)\n", presets_text());
  if (suggested.label_map) text += "           --labels all (looks like a mask or label map)\n";
  for (const LabelName& label : info.labels) {
    text += fmt::format("label      {} {}\n", label.label.text(), printable(label.name));
  }
  for (const std::string& note : info.notes) text += fmt::format("warning    {}\n", printable(note));
  for (const std::string& remark : info.remarks) text += fmt::format("note       {}\n", printable(remark));
  text += histogram_text(histogram, value_text);
  return text;
}

void run_info(const InfoArguments& arguments) {
  if (arguments.input.path.empty()) throw CLI::RequiredError("VOLUME");
  if (arguments.page.given()) check_page(arguments.page, "--html");
  check_different({arguments.input.path, arguments.page.path});
  check_absent(arguments.no_clobber, {arguments.page.path});
  exit_on_signal();
  std::optional<OutputFile> page;
  if (arguments.page.given()) page.emplace(arguments.page.path);
  const std::unique_ptr<SliceSource> volume = open_input(arguments.input);
  CrossingCounts crossings;
  if (arguments.isos) {
    crossings = count_crossings(*volume);
  } else {
    crossings.histogram = read_histogram(*volume);
  }
  const Histogram& histogram = crossings.histogram;
  const Suggestions suggested = suggestions(histogram, arguments.input, nullptr);
  const VolumeInfo& info = volume->info();
  const std::string& path = arguments.input.path;
  Json json = info_json(info, histogram, suggested, path);
  if (arguments.isos) json["isos"] = isos_json(crossings);
  if (page) write_range_page(*page, json);
  if (arguments.json) return print_out(json_text(json));
  print_to_reader(info_text(info, histogram, suggested, path) +
                  (arguments.isos ? isos_text(crossings, ValueText(histogram)) : ""));
}

}  // namespace

void add_info_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("info", "Show what a volume is, and iso-values for it");
  const auto arguments = std::make_shared<InfoArguments>();
  add_input_options(*verb, arguments->input);
  verb->add_flag("--json", arguments->json, "Print JSON");
  verb->add_flag("--isos", arguments->isos, "Triangles of the surface for iso-values over the whole range");
  verb->add_option("--html", arguments->page.path, "Write a page with a chart of --isos to this file")->needs("--isos");
  add_clobber_option(*verb, arguments->no_clobber);
  verb->footer(kInfoExamples);
  verb->callback([arguments] { run_info(*arguments); });
}

}  // namespace isoweave::cli
