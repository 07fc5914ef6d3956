// isoweave generate: test volumes from formulas.
#include "isoweave/generate.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "isoweave/error.hpp"
#include "options/files.hpp"
#include "options/run.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kGenerateExamples = R"(
Examples:
  isoweave generate gyroid --size 64 -o gyroid.nrrd
  isoweave generate sphere --size 64x64x32 --type uint8 -o sphere.nrrd)";

struct GenerateArguments {
  std::string kind, output, size, type = "float32", spacing = "1,1,1", progress = "auto";
  std::uint64_t seed = 1;
  bool quiet = false, no_clobber = false;
};

// A source that shows how far a volume has been read, and stops when asked to.
class WatchedSource final : public SliceSource {
 public:
  WatchedSource(SliceSource& source, ProgressPrinter& printer, const std::atomic<bool>& stop)
      : source_(source), printer_(printer), stop_(stop) {}

  const VolumeInfo& info() const override { return source_.info(); }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    const std::size_t slice = info().slice_bytes();
    for (std::int64_t k = first; k < first + count; ++k) {
      if (stop_) throw Interrupted("interrupted, nothing was written");
      source_.read(k, 1, out.subspan(static_cast<std::size_t>(k - first) * slice));
      Progress progress;
      progress.layer = k + 1;
      progress.layers = info().dims[2];
      progress.voxels = static_cast<std::uint64_t>((k + 1) * info().slice_samples());
      printer_.show(progress);
    }
  }

 private:
  SliceSource& source_;
  ProgressPrinter& printer_;
  const std::atomic<bool>& stop_;
};

std::string kinds_text() {
  std::string text;
  for (const std::string& kind : generator_kinds()) text += (text.empty() ? "" : ", ") + kind;
  return text;
}

void run_generate(const GenerateArguments& arguments) {
  GenerateOptions options;
  options.kind = arguments.kind;
  options.dims = parse_size("--size", arguments.size);
  const std::optional<SampleType> type = parse_sample_type(type_name(arguments.type));
  if (!type) wrong_value("--type", "a type such as uint8, int16 or float32", arguments.type);
  options.type = *type;
  options.spacing = parse_spacing("--spacing", arguments.spacing);
  options.seed = arguments.seed;
  const ProgressMode mode = progress_mode(arguments.progress, arguments.quiet);

  check_absent(arguments.no_clobber, {arguments.output});
  const std::unique_ptr<SliceSource> volume = generate_volume(options);
  ProgressPrinter printer(mode);
  WatchedSource watched(*volume, printer, stop_on_signal());
  write_volume(watched, arguments.output);
  printer.finish();
  if (!arguments.quiet) {
    print_note(fmt::format("{}: {} x {} x {} {}, surface at --iso {}", arguments.output, options.dims[0],
                           options.dims[1], options.dims[2], arguments.type,
                           suggested_iso(options.kind, options.type)));
  }
}

}  // namespace

void add_generate_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("generate", "Make a test volume from a formula");
  const auto arguments = std::make_shared<GenerateArguments>();
  verb->add_option("KIND", arguments->kind, kinds_text())->required();
  verb->add_option("-o,--output", arguments->output, "Volume to write: .nrrd, .mha or .raw")->required();
  verb->add_option("--size", arguments->size, "Samples: N, or WxHxD")->required();
  verb->add_option("--type", arguments->type, "uint8, int16, float32, ...")->capture_default_str();
  verb->add_option("--spacing", arguments->spacing, "x,y,z")->capture_default_str();
  verb->add_option("--seed", arguments->seed, "For the kinds with chance in them")->capture_default_str();
  verb->add_option("--progress", arguments->progress, "auto (a bar on a terminal), always or never")
      ->capture_default_str();
  add_clobber_option(*verb, arguments->no_clobber);
  verb->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  verb->footer(kGenerateExamples);
  verb->callback([arguments] { run_generate(*arguments); });
}

}  // namespace isoweave::cli
