// The options of a page, and the checks on them before any work is done.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>

#include "options/values.hpp"
#include "page/page.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

void require_viewer(std::string_view wanted) {
#ifdef ISOWEAVE_HAS_VIEWER
  static_cast<void>(wanted);
#else
  throw std::invalid_argument(
      fmt::format("{}: expected a build with the viewer (CMake option ISOWEAVE_VIEWER=ON, which needs node, npm and "
                  "meshoptimizer), this one has none",
                  wanted));
#endif
}

}  // namespace

void add_page_options(CLI::App& verb, PageOptions& page) {
  verb.add_option("--html", page.path, "Write a page that shows mesh and report in a browser to this file");
  add_page_triangles(verb, page);
  verb.get_option("--page-triangles")->needs("--html");
}

void add_page_triangles(CLI::App& verb, PageOptions& page) {
  verb.add_option("--page-triangles", page.triangles, "The page shows a stand-in for a mesh of more triangles")
      ->capture_default_str();
}

void check_page(const PageOptions& page, std::string_view wanted) {
  require_viewer(wanted);
  parse_count("--page-triangles", page.triangles);
}

void check_page(const PageOptions& page, const OutputOptions& output) {
  if (!page.given()) return;
  check_page(page, "--html");
  const bool readable = output.to_stdout.empty() && !output.compress && !output.one_file && !output.placing.given();
  if (readable && output_format(output) != MeshFormat::kPrecomputed) return;
  const std::string found = !output.to_stdout.empty() ? "--to-stdout"
                            : output.compress         ? "--compress"
                            : output.one_file         ? "--one-file"
                            : output.placing.given()  ? "one that is scaled or moved"
                                                      : output.path;
  wrong_value("--html", "a mesh file that isoweave can read again", found);
}

}  // namespace isoweave::cli
