// isoweave view: a page for a mesh, or for a report and its mesh.
#include <CLI/CLI.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "isoweave/error.hpp"
#include "isoweave/measure.hpp"
#include "options/files.hpp"
#include "options/input_mesh.hpp"
#include "options/values.hpp"
#include "page/open_page.hpp"
#include "page/page.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kViewExamples = R"(
Examples:
  isoweave view bone.ply --open
  isoweave view bone.json -o bone.html --before full.ply

The report is one that mesh or simplify wrote (--report); the page shows the
mesh that it names.)";

struct ViewArguments {
  ReadMeshOptions reading;
  std::string input, before, threads = "all";
  PageOptions page;
  bool quiet = false, no_clobber = false, open = false;
};

// Whether a file is a report. A scene of glTF begins like a report as well, and is told by its name. A pipe, which can
// be read once, is taken for a mesh.
bool is_report(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || path.ends_with(".gltf")) return false;
  std::ifstream file(path, std::ios::binary);
  char c = ' ';
  while (std::isspace(static_cast<unsigned char>(c)) != 0 && file.get(c)) continue;
  return c == '{';
}

Json read_report(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Json report = Json::parse(text, nullptr, false);
  const bool known = report.is_object() && report.contains("output") && report["output"].is_string() &&
                     report.contains("triangles") && report["triangles"].is_number_unsigned();
  if (!known) throw BadInput(path + ": expected a report that names its mesh as \"output\", found another file");
  return report;
}

// The path of the mesh of a report: as the run had it, or beside the report when both were moved.
std::string mesh_of(const Json& surface, const std::string& report_path) {
  if (!surface.is_object() || !surface.contains("output") || !surface["output"].is_string()) {
    throw BadInput(report_path + ": expected levels that name their meshes as \"output\", found others");
  }
  const std::filesystem::path named = surface["output"].get<std::string>();
  std::error_code error;
  if (std::filesystem::exists(named, error)) return named.string();
  const std::filesystem::path beside = std::filesystem::path(report_path).parent_path() / named.filename();
  if (std::filesystem::exists(beside, error)) return beside.string();
  throw BadInput(
      fmt::format("{}: expected the mesh {} of the report, found no such file", report_path, named.string()));
}

void run_view(ViewArguments arguments) {
  check_page(arguments.page, "view");
  RunControl control;
  control.threads = parse_threads(arguments.threads);
  if (!arguments.page.given()) arguments.page.path = (arguments.input == "-" ? "stdin" : arguments.input) + ".html";

  check_absent(arguments.no_clobber, {arguments.page.path});
  exit_on_signal();
  const bool reported = is_report(arguments.input);
  Json report = reported ? read_report(arguments.input) : Json::object();
  const std::string mesh_path = reported ? mesh_of(report, arguments.input) : arguments.input;
  check_different(
      {arguments.input, mesh_path == arguments.input ? "" : mesh_path, arguments.before, arguments.page.path});
  OutputFile file(arguments.page.path);
  PageContents contents{read_named_mesh(mesh_path, arguments.reading)};
  if (!arguments.quiet) print_mesh_warnings(mesh_path, contents.mesh);
  if (report.contains("levels")) {
    for (const Json& level : report["levels"]) contents.finer.push_back(read_mesh(mesh_of(level, arguments.input)));
  }
  if (arguments.before.empty()) {
    contents.full_note =
        "No surface from before simplification was given: there is no before and after, and no "
        "error to show (isoweave view --before MESH, or --html of the run itself).";
  } else {
    contents.full = read_named_mesh(arguments.before, arguments.reading);
    for (const std::string& note : match_place(*contents.full, contents.mesh)) {
      if (!arguments.quiet) print_note(arguments.before + ": " + note);
    }
    report["before"] = arguments.before;
  }
  if (!reported) report["version"] = ISOWEAVE_VERSION;
  if (!reported && !contents.mesh.space.empty()) report["space"] = contents.mesh.space;
  report["output"] = mesh_path;
  control.stop = borrow(stop_on_signal());
  write_page(file, arguments.page, report, std::move(contents), control);
  if (arguments.open) return open_page(arguments.page.path);
  if (!arguments.quiet) print_note(arguments.page.path + ": open it in a browser, which --open does");
}

}  // namespace

void add_view_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("view", "Write a page that shows a mesh in a browser");
  const auto arguments = std::make_shared<ViewArguments>();
  verb->add_option("MESH|REPORT", arguments->input, "Mesh, or report that mesh or simplify wrote")->required();
  verb->add_option("-o,--output", arguments->page.path, "Page to write (default: the name and .html)");
  verb->add_flag("--open", arguments->open, "Open the page in the browser of the desktop (xdg-open; open on macOS)");
  verb->add_option("--before", arguments->before, "Mesh before simplification, to compare with");
  add_page_triangles(*verb, arguments->page);
  add_external_option(*verb, arguments->reading);
  verb->add_option("--threads", arguments->threads, "Threads, or all")->capture_default_str();
  add_clobber_option(*verb, arguments->no_clobber);
  verb->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  verb->footer(kViewExamples);
  verb->callback([arguments] { run_view(*arguments); });
}

}  // namespace isoweave::cli
