// The page in builds with the viewer.
#include "page/page.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "isoweave/measure.hpp"
#include "options/values.hpp"
#include "page/page_geometry.hpp"
#include "page/page_script.hpp"
#include "page/page_surfaces.hpp"
#include "page/page_template.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

Json bins_json(const PageErrors& errors) {
  const auto count = static_cast<double>(errors.counts.size());
  Json bins = Json::array();
  for (std::size_t bin = 0; bin < errors.counts.size(); ++bin) {
    const auto place = static_cast<double>(bin);
    bins.push_back({{"from", errors.max * place / count},
                    {"to", errors.max * (place + 1) / count},
                    {"vertices", errors.counts[bin]}});
  }
  return bins;
}

Json errors_json(const PageErrors& errors) {
  Json json = {{"vertices", errors.vertices},
               {"mean", errors.mean},
               {"rms", errors.rms},
               {"max", errors.max},
               {"bins", bins_json(errors)}};
  if (errors.sampled) {
    json["samples"] = errors.samples;
    json["sampled"] = Json::parse(distances_json(*errors.sampled));
  }
  return json;
}

Json surfaces_json(const std::vector<PageSurface>& surfaces) {
  Json json = Json::array();
  for (const PageSurface& surface : surfaces) {
    json.push_back({{"name", surface.name},
                    {"triangles", surface.mesh.triangles.size()},
                    {"vertices", surface.mesh.vertices.size()}});
    if (surface.level) json.back()["level"] = *surface.level;
    if (surface.iso) json.back()["iso"] = *surface.iso;
  }
  return json;
}

bool has_stand_in(const std::vector<PageSurface>& surfaces) {
  return std::ranges::any_of(surfaces, &PageSurface::stands_in);
}

// Whether the mesh of a file is another one than its run reported.
bool differs(const Json& run, const Json& check) {
  const auto digest = run.find("digest");
  return digest != run.end() && digest->is_string() && *digest != check.at("digest");
}

// The notes that a reader of the page needs.
Json notes_json(const PageSurfaces& page, bool differs, const std::string& full_note) {
  Json notes = Json::array();
  if (page.surfaces.empty()) notes.push_back("The mesh has no triangles.");
  if (has_stand_in(page.surfaces)) {
    notes.push_back(
        "What is drawn is a stand-in: the mesh has more triangles than a page shows (--page-triangles). "
        "Counts, checks and distances are those of the mesh.");
  }
  if (page.lacks_finer) {
    notes.push_back("Levels of detail with more triangles than a page shows (--page-triangles) are left out.");
  }
  if (page.full_triangles > 0) {
    notes.push_back(
        fmt::format("The surface before simplification has {} triangles. What is drawn of it is a stand-in of {}; the "
                    "distances are those to the surface itself.",
                    grouped(page.full_triangles), grouped(page.surfaces.front().mesh.triangles.size())));
  }
  if (!full_note.empty()) notes.push_back(full_note);
  if (differs) {
    notes.push_back("The mesh in the file has another digest than the run reported: it was rounded, or changed since.");
  }
  return notes;
}

Json file_check_json(const TriangleMesh& mesh, const std::string& path) {
  Json json = Json::parse(check_json(check_mesh(mesh), path));
  json.update(place_json(mesh));
  return json;
}

// Adds the page of one surface to the report, and makes its surfaces.
PageSurfaces describe_surface(Json& report, PageContents contents, std::uint64_t most_triangles,
                              const RunControl& control) {
  Json& json = report["page"];
  json["check"] = file_check_json(contents.mesh, report["output"]);
  const std::string full_note = std::move(contents.full_note);
  PageSurfaces shown = page_surfaces(std::move(contents), most_triangles, control);
  json["surfaces"] = surfaces_json(shown.surfaces);
  json["distance"] = shown.errors ? errors_json(*shown.errors) : Json(nullptr);
  json["notes"] = notes_json(shown, differs(report, json["check"]), full_note);
  return shown;
}

// Adds the page of several iso-values to the report, and makes their surfaces.
PageSurfaces describe_isos(Json& report, std::vector<TriangleMesh> isos, std::uint64_t most_triangles,
                           const RunControl& control) {
  Json& json = report["page"];
  json["isos"] = Json::array();
  bool any_differs = false;
  for (std::size_t n = 0; n < isos.size(); ++n) {
    const Json& run = report["isos"][n];
    json["isos"].push_back(file_check_json(isos[n], run.at("output")));
    any_differs = any_differs || differs(run, json["isos"].back());
  }
  PageSurfaces shown = iso_surfaces(std::move(isos), most_triangles, control);
  json["surfaces"] = surfaces_json(shown.surfaces);
  json["distance"] = nullptr;
  json["notes"] = notes_json(shown, any_differs, "");
  return shown;
}

}  // namespace

std::uint64_t page_memory(std::uint64_t triangles, std::uint64_t triangles_before) {
  constexpr std::uint64_t kBytesPerTriangle = 220;
  constexpr std::uint64_t kElse = 200'000'000;          // the full surface, what it is measured with, the text
  constexpr std::uint64_t kBytesPerTriangleBefore = 6;  // of one that is not held: a vertex for two triangles
  const std::uint64_t pieces = triangles_before > kMostFullTriangles ? triangles_before * kBytesPerTriangleBefore : 0;
  return triangles * kBytesPerTriangle + pieces + kElse;
}

void write_page(OutputFile& file, const PageOptions& page, Json& report, PageContents contents,
                const RunControl& control) {
  const auto most_triangles = static_cast<std::uint64_t>(parse_count("--page-triangles", page.triangles));
  PageSurfaces shown = contents.isos.empty() ? describe_surface(report, std::move(contents), most_triangles, control)
                                             : describe_isos(report, std::move(contents.isos), most_triangles, control);
  const std::string_view html = page_template();
  const std::size_t mark = html.find(kPageMark);
  write_text(file, html.substr(0, mark));
  write_script(file, "report", report);
  for (std::size_t i = 0; i < shown.surfaces.size(); ++i) {
    write_script(file, fmt::format("surface-{}", i), packed_surface(std::move(shown.surfaces[i])));
  }
  write_text(file, html.substr(mark + kPageMark.size()));
  file.commit();
}

}  // namespace isoweave::cli
