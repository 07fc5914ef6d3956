// The calls of the C interface on meshes that are there, and those without a room of their own.
#include <cstring>
#include <stdexcept>
#include <string>

#include "capi/guard.hpp"
#include "capi/handles.hpp"
#include "capi/json_reports.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/mesh.hpp"

namespace isoweave::capi {
namespace {

// The elements of an array of the caller's. They may be at any address, as in C.
template <class Element, class Number>
std::vector<Element> copied(const Number* numbers, std::uint64_t count, const char* name) {
  std::vector<Element> elements(count);
  if (count > 0) std::memcpy(elements.data(), &required(numbers, name), count * sizeof(Element));
  return elements;
}

TriangleMesh mesh_of(const iw_mesh_arrays& arrays) {
  TriangleMesh mesh;
  mesh.vertices = copied<Point>(arrays.points, arrays.vertices, "points");
  mesh.triangles = copied<std::array<std::uint32_t, 3>>(arrays.corners, arrays.triangles, "corners");
  if (arrays.normals != nullptr) mesh.normals = copied<Point>(arrays.normals, arrays.vertices, "normals");
  if (arrays.values != nullptr) mesh.values = copied<float>(arrays.values, arrays.vertices, "values");
  std::ranges::copy(arrays.offset, mesh.offset.begin());
  mesh.unit = text_of(arrays.unit);
  mesh.space = text_of(arrays.space);
  return mesh;
}

// The arrays of a mesh in memory or of any other: both have the same members, as spans or as vectors.
template <class Vertices, class Normals, class Values, class Triangles>
iw_mesh_arrays arrays_of(const Vertices& vertices, const Normals& normals, const Values& values,
                         const Triangles& triangles) {
  iw_mesh_arrays arrays{};
  arrays.vertices = vertices.size();
  arrays.triangles = triangles.size();
  arrays.points = vertices.empty() ? nullptr : vertices.front().data();
  arrays.corners = triangles.empty() ? nullptr : triangles.front().data();
  arrays.normals = normals.empty() ? nullptr : normals.front().data();
  arrays.values = values.empty() ? nullptr : values.data();
  return arrays;
}

iw_mesh_arrays arrays_of(const iw_mesh& mesh) {
  iw_mesh_arrays arrays{};
  if (const auto* read = std::get_if<TriangleMesh>(&mesh.content)) {
    arrays = arrays_of(read->vertices, read->normals, read->values, read->triangles);
    std::ranges::copy(read->offset, arrays.offset);
  } else {
    const auto& made = std::get<MeshInMemory>(mesh.content);
    arrays = arrays_of(made.vertices(), made.normals(), made.values(), made.triangles());
    std::ranges::copy(made.offset(), arrays.offset);
  }
  arrays.unit = mesh.unit.c_str();
  arrays.space = mesh.space.c_str();
  return arrays;
}

void hold(iw_mesh** mesh, TriangleMesh content) {
  required(mesh, "mesh") = nullptr;
  std::string unit = content.unit;
  std::string space = content.space;
  *mesh = new iw_mesh{std::move(content), std::move(unit), std::move(space)};
}

void write(const iw_mesh& mesh, const std::string& path, bool compress) {
  TriangleMesh copy;
  const TriangleMesh& all = triangle_mesh(mesh, copy);
  MeshFileOptions options;
  options.normals = !all.normals.empty();
  options.values = !all.values.empty() && holds_values(mesh_format(path));
  options.comments = {"isoweave " ISOWEAVE_VERSION};
  options.compress = compress;
  write_mesh(path, all, options);
}

Json compared(const iw_mesh& given_a, const iw_mesh& given_b, const iw_compare_options& options) {
  TriangleMesh copy_a, copy_b;
  const TriangleMesh& a = triangle_mesh(given_a, copy_a);
  TriangleMesh b = triangle_mesh(given_b, copy_b);
  DistanceOptions asked;
  if (options.samples > 0) asked.samples = options.samples;
  asked.threads = options.threads;
  const std::vector<std::string> notes = match_place(b, a);
  Json json = {{"version", ISOWEAVE_VERSION}, {"samples", asked.samples}, {"unit", a.unit}, {"notes", notes}};
  json.update(Json::parse(distances_json(compare_meshes(a, b, asked))));
  if (options.distances != nullptr) std::ranges::copy(vertex_distances(a, b, asked.threads), options.distances);
  return json;
}

}  // namespace

const TriangleMesh& triangle_mesh(const iw_mesh& mesh, TriangleMesh& copy) {
  if (const auto* read = std::get_if<TriangleMesh>(&mesh.content)) return *read;
  copy = std::get<MeshInMemory>(mesh.content).copy();
  copy.unit = mesh.unit;
  copy.space = mesh.space;
  return copy;
}

}  // namespace isoweave::capi

using namespace isoweave;        // NOLINT(google-build-using-namespace): the C interface has none
using namespace isoweave::capi;  // NOLINT(google-build-using-namespace)

uint32_t iw_abi_version() { return IW_ABI_VERSION; }

const char* iw_version() { return ISOWEAVE_VERSION; }

void iw_result_clear(iw_result* result) {
  guarded(result, [] {});
}

iw_stop* iw_stop_new() {
  iw_stop* stop = nullptr;
  guarded(nullptr, [&] { stop = new iw_stop; });
  return stop;
}

void iw_stop_set(iw_stop* stop) { *stop->wish = true; }

void iw_stop_free(iw_stop* stop) { delete stop; }

iw_status iw_mesh_from_arrays(const iw_mesh_arrays* arrays, iw_mesh** mesh, iw_result* result) {
  return guarded(result, [&] { hold(mesh, mesh_of(taken(&required(arrays, "arrays")))); });
}

iw_status iw_read_mesh(const char* path, int32_t no_external, iw_mesh** mesh, iw_result* result) {
  return guarded(result, [&] {
    TriangleMesh content = read_mesh(&required(path, "path"), {.external = no_external == 0});
    const Json notes = {{"notes", content.notes}};
    hold(mesh, std::move(content));
    set_report(result, text_of(notes));
  });
}

iw_status iw_get_mesh_arrays(const iw_mesh* mesh, iw_mesh_arrays* arrays, iw_result* result) {
  return guarded(result, [&] { hand_back(arrays_of(required(mesh, "mesh")), arrays); });
}

iw_status iw_write_mesh(const iw_mesh* mesh, const char* path, int32_t compress, iw_result* result) {
  return guarded(result, [&] { write(required(mesh, "mesh"), &required(path, "path"), compress != 0); });
}

iw_status iw_check_mesh(const iw_mesh* mesh, int32_t self_intersections, int32_t threads, iw_result* result) {
  return guarded(result, [&] {
    TriangleMesh copy;
    const TriangleMesh& all = triangle_mesh(required(mesh, "mesh"), copy);
    Json json = Json::parse(check_json(check_mesh(all)));
    if (self_intersections != 0)
      json["self_intersections"] = Json::parse(self_intersections_json(count_self_intersections(all, 10, threads)));
    set_report(result, text_of(json));
  });
}

iw_status iw_compare_meshes(const iw_mesh* a, const iw_mesh* b, const iw_compare_options* options, iw_result* result) {
  return guarded(result,
                 [&] { set_report(result, text_of(compared(required(a, "a"), required(b, "b"), taken(options)))); });
}

void iw_free_mesh(iw_mesh* mesh) { delete mesh; }
