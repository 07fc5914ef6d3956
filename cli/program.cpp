// The command line: picks the verb, and turns every error into one line and an exit code.
#include "program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <sstream>
#include <stdexcept>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "help/help_text.hpp"
#include "help/manual.hpp"
#include "help/option_table.hpp"
#include "help/usage_errors.hpp"
#include "options/values.hpp"
#include "ranks.hpp"
#include "report/print.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kProgramExamples = R"(
Examples:
  isoweave info scan.nii.gz
  isoweave mesh scan.nii.gz --iso 300 -o bone.ply
  isoweave check bone.ply
  isoweave render bone.ply -o bone.png

Exit codes: 0 done, 2 usage, 3 bad input, 4 cannot write, 5 not enough memory,
6 device, 130 interrupted.
isoweave help VERB says more.)";

constexpr const char* kRankProgramExamples = R"(
Examples:
  mpirun -n 64 isoweave-mpi mesh huge.zarr --iso 100 -o huge.ply
  mpirun -n 4 isoweave-mpi mesh ct.raw --raw 4096x4096x4096:uint16 --iso 3000 \
    --memory 8G --checkpoint run -o ct.ply

Options are those of isoweave mesh. Every rank must see the volume. --threads and
--memory are those of each rank. After a run that was cut off, the same command
goes on from its --checkpoint, with any number of ranks.)";

std::string name() { return rank_link() == nullptr ? "isoweave" : "isoweave-mpi"; }

void check_verb(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::string verbs;
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs_of(app)) {
    names.push_back(verb->get_name());
    if (!arguments.empty() && verb->get_name() == arguments[0]) return;
    verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
  }
  if (arguments.empty()) throw std::invalid_argument("expected a verb: " + verbs + "; see " + name() + " --help");
  if (arguments[0].starts_with('-')) return;
  const std::string meant = nearest(arguments[0], names);
  wrong_value("verb", "one of " + verbs, arguments[0] + (meant.empty() ? "" : "', did you mean '" + meant));
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

// Prints what "isoweave help ..." asks for: a man page or a script for a shell.
void print_manual(const CLI::App& app, const std::vector<std::string>& arguments) {
  const std::string last = arguments.size() > 2 ? arguments[2] : "";
  if (arguments[1] == "--completion") return print_to_reader(completion_script(app, last));
  if (!last.empty()) check_verb(app, {last});
  print_to_reader(man_page(last.empty() ? app : *app.get_subcommand(last)));
}

// "help VERB" is "VERB --help".
std::vector<std::string> without_help_verb(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments[0] != "help") return arguments;
  if (arguments.size() == 1) return {"--help"};
  return {arguments[1], "--help"};
}

// The verbs. Ranks only have the one that they share the work of.
void add_verbs(CLI::App& app) {
  add_mesh_verb(app);
  if (rank_link() != nullptr) return;
  add_simplify_verb(app);
  add_info_verb(app);
  add_index_verb(app);
  add_check_verb(app);
  add_compare_verb(app);
  add_render_verb(app);
  add_view_verb(app);
  add_generate_verb(app);
  add_plan_verb(app);
  add_work_verb(app);
  add_status_verb(app);
  add_collect_verb(app);
}

void describe(CLI::App& app) {
  refuse_empty_values(app);
  describe_options(app);
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; })) describe_options(*verb);
}

// The verb whose help tells of a usage error: " mesh", or nothing.
std::string verb_in(const CLI::App& app, const std::vector<std::string>& arguments) {
  for (const CLI::App* verb : verbs_of(app)) {
    if (!arguments.empty() && arguments[0] == verb->get_name()) return " " + arguments[0];
  }
  return "";
}

[[noreturn]] void refuse(const CLI::App& app, const std::vector<std::string>& arguments, const std::string& message) {
  throw std::invalid_argument(fmt::format("{}; see {}{} --help", message, name(), verb_in(app, arguments)));
}

void parse(CLI::App& app, const std::vector<std::string>& arguments) {
  const std::string name = verb_in(app, arguments);
  const CLI::App& verb = name.empty() ? app : *app.get_subcommand(arguments[0]);
  const std::string unknown = name.empty() ? "" : unknown_option(verb, arguments);
  if (!unknown.empty()) refuse(app, arguments, unknown);
  try {
    // CLI11 takes the arguments from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& wish) {
    std::ostringstream text;
    app.exit(wish, text, text);
    print_to_reader(text.str());
  } catch (const CLI::ExtrasError& error) {
    const std::string extra = extra_text(verb, arguments);
    refuse(app, arguments, extra.empty() ? error.what() : extra);
  } catch (const CLI::ArgumentMismatch& error) {
    refuse(app, arguments, mismatch_text(error.what()));
  } catch (const CLI::ParseError& error) {
    refuse(app, arguments, missing_text(error.what()));
  }
}

int run(const std::vector<std::string>& given) {
  CLI::App app("Turn large 3-D volumes into simplified triangle meshes", name());
  app.set_version_flag("--version", "isoweave " ISOWEAVE_VERSION, "Show the version");
  app.set_help_flag("-h,--help", "Show this help");
  app.require_subcommand(1);
  app.footer(rank_link() == nullptr ? kProgramExamples : kRankProgramExamples);
  use_help_text(app);
  add_verbs(app);
  describe(app);
  if (given.size() > 1 && given[0] == "help" && given[1].starts_with("--")) {
    print_manual(app, given);
    return 0;
  }
  const std::vector<std::string> arguments = without_help_verb(given);
  check_verb(app, arguments);
  parse(app, arguments);
  return 0;
}

// glibc takes larger and larger blocks from its heaps, once such blocks have been freed. The lists of a slab have other
// sizes than those of the last one, so parts of the heaps stay unused. With a fixed bound, blocks above it go back.
void give_back_large_blocks() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

}  // namespace

int run_program(int argc, char** argv) {
  give_back_large_blocks();
  ignore_write_signals();
  occupy_standard_streams();
  try {
    return run(std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
  } catch (const std::exception& error) {
    return report_error(error);
  }
}

}  // namespace isoweave::cli
