// The command line: picks the verb, and turns every error into one line and an exit code.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <sstream>
#include <stdexcept>

#include "options/values.hpp"
#include "report/print.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kExamples = R"(
Examples:
  isoweave info scan.nii.gz
  isoweave mesh scan.nii.gz -o bone.ply --iso 300 --error 0.2vox --report bone.json
  isoweave mesh foot_256x256x256_uint8.raw -o foot.stl --iso auto
  isoweave check bone.ply
  isoweave compare bone.ply reference.ply --voxel 0.5
  isoweave render bone.ply -o bone.png
  isoweave view bone.ply

Exit codes: 0 done, 2 usage, 3 bad input, 4 cannot write, 5 not enough memory, 6 device, 130 interrupted.
isoweave VERB --help says more.)";

void check_verb(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::string verbs;
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (!arguments.empty() && verb->get_name() == arguments[0]) return;
    verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
  }
  if (arguments.empty()) throw std::invalid_argument("expected a verb: " + verbs + "; see isoweave --help");
  if (!arguments[0].starts_with('-')) wrong_value("verb", "one of " + verbs, arguments[0]);
}

// Empty values are refused: where a variable of a script is empty, its option would be ignored in silence.
void refuse_empty_values(CLI::App& app) {
  const auto check = [](const std::string& value) { return value.empty() ? "expected a value, found ''" : ""; };
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; })) {
    for (CLI::Option* option : verb->get_options()) {
      if (!option->get_positional()) option->check(check);
    }
  }
}

int run(const std::vector<std::string>& arguments) {
  CLI::App app("Large volumes to simplified triangle surfaces, exactly, in bounded memory", "isoweave");
  app.set_version_flag("--version", "isoweave " ISOWEAVE_VERSION);
  app.set_help_flag("-h,--help", "Say what there is");
  app.require_subcommand(1);
  app.footer(kExamples);
  add_mesh_verb(app);
  add_simplify_verb(app);
  add_info_verb(app);
  add_index_verb(app);
  add_check_verb(app);
  add_compare_verb(app);
  add_render_verb(app);
  add_view_verb(app);
  add_generate_verb(app);
  refuse_empty_values(app);
  try {
    check_verb(app, arguments);
    // CLI11 takes the arguments from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& wish) {
    std::ostringstream text;
    app.exit(wish, text, text);
    print_to_reader(text.str());
  } catch (const CLI::ParseError& error) {
    throw std::invalid_argument(std::string(error.what()) + "; see isoweave --help");
  }
  return 0;
}

}  // namespace
}  // namespace isoweave::cli

int main(int argc, char** argv) {
  isoweave::cli::ignore_write_signals();
  isoweave::cli::occupy_standard_streams();
  try {
    return isoweave::cli::run(std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
  } catch (const std::exception& error) {
    return isoweave::cli::report_error(error);
  }
}
