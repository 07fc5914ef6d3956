// The page that shows a mesh and the report of its run in a browser: one file, which holds all it needs. viewer/ has
// its sources; builds without the viewer refuse to make one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/mesh.hpp"
#include "isoweave/output_file.hpp"
#include "isoweave/pipeline.hpp"
#include "options/cli_app.hpp"
#include "options/output_mesh.hpp"
#include "page/piece_distances.hpp"
#include "report/report.hpp"

namespace isoweave::cli {

// A page holds the surface before simplification as well, as it is where that has no more triangles than this, and else
// a stand-in of so many.
inline constexpr std::uint64_t kMostFullTriangles = 1'000'000;

struct PageOptions {
  std::string path;  // empty: no page
  std::string triangles = "2000000";

  bool given() const { return !path.empty(); }
};

// --html and --page-triangles.
void add_page_options(CLI::App& verb, PageOptions& page);
void add_page_triangles(CLI::App& verb, PageOptions& page);

// Refuses with std::invalid_argument, before any work: `wanted`, the option or verb, in a build without the viewer, and
// an invalid number of triangles.
void check_page(const PageOptions& page, std::string_view wanted);

// Refuses likewise, and refuses a mesh that cannot be read again once it is written.
void check_page(const PageOptions& page, const OutputOptions& output);

// The memory, about, that making a page takes, from a mesh and a surface before simplification of so many triangles.
std::uint64_t page_memory(std::uint64_t triangles, std::uint64_t triangles_before);

struct PageContents {
  TriangleMesh mesh;
  std::optional<TriangleMesh> full{};  // before simplification; or what stands in for it
  std::uint64_t full_triangles = 0;    // of the surface that `full` stands in for; 0: it is that surface
  SurfacePass full_pass{};             // where `full` stands in for another surface: that one
  std::string full_note{};             // why it is not there
  std::vector<TriangleMesh> finer{};   // levels of detail before `mesh`, finest first
  std::vector<TriangleMesh> isos{};    // in place of `mesh`: those of the report's `isos`, in their order
};

// Adds the contents of the page beside the report to it, as "page", and completes the file.
void write_page(OutputFile& file, const PageOptions& page, Json& report, PageContents contents,
                const RunControl& control);

}  // namespace isoweave::cli
