// The calls of the C interface that make meshes, and the forecast.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "capi/call_checkpoint.hpp"
#include "capi/call_options.hpp"
#include "capi/call_outputs.hpp"
#include "capi/guard.hpp"
#include "capi/handles.hpp"
#include "capi/json_reports.hpp"
#include "isoweave/label_names.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::capi {
namespace {

// A run over a volume, with everything that its options ask of the volume.
struct VolumeRun {
  const VolumeOpener& opener;
  iw_mesh_options given;
  iw_simplify_options simplify;
  iw_run way;
  MeshOptions options;
  RunControl control;

  VolumeRun(const iw_volume* volume, const iw_mesh_options* options_given, const iw_run* run)
      : opener(*required(volume, "volume").opener),
        given(taken(options_given)),
        simplify(taken(given.simplify)),
        way(taken(run)),
        options(mesh_options(given, simplify, info())),
        control(run_control(way)) {
    control.reopen = [&again = opener] { return again.open(); };
  }

  const VolumeInfo& info() const { return opener.info(); }

  // Chooses the components, if some are to be dropped, in a pass over the volume that is not part of the progress, and
  // not saved.
  void pass_before() {
    const ComponentRule rule = component_rule(simplify);
    if (rule.keeps_all()) return;
    RunControl silent = control;
    silent.progress = {};
    silent.memory = 0;
    silent.checkpoint = {};
    silent.resume.reset();
    options.components = std::make_shared<ComponentChoice>(choose_components(*opener.open(), options, rule, silent));
  }

  // How the mesh of this run is written.
  MeshFileOptions file() const {
    MeshFileOptions file;
    file.normals = options.normals != Normals::kAbsent;
    file.values = options.values != nullptr;
    file.comments = {"isoweave " ISOWEAVE_VERSION};
    file.unit = info().geometry.unit;
    file.space = space_of_mesh(info().geometry, options.space);
    file.offset = mesh_offset(info(), options.space);
    return file;
  }
};

Json report_of(const VolumeRun& run, const MeshReport& report, const MeshFileOptions& file) {
  Json input = Json::parse(volume_json(run.info()));
  input.update(Json::parse(range_json(report.min, report.max, report.nan)));
  Json json = run_json(report, std::move(input));
  json["closed"] = run.options.closed;
  json["smooth"] = run.options.smooth;
  json["extractor"] = extractor_name(run.options.extractor);
  json["space"] = file.space;
  json["offset"] = file.offset;
  return json;
}

const char* inside_of(const VolumeRun& run) { return run.options.inside_above ? "above" : "below"; }

void mesh_into(VolumeRun& run, iw_output* outputs, std::size_t count, iw_result* result) {
  const MeshFileOptions file = run.file();
  const CallCheckpoint saved(run.way, count, run.control);
  CallOutputs sinks(outputs, count, file, saved.meshes());
  run.pass_before();
  const MeshReport report = mesh_volume(*run.opener.open(), sinks.pointers(), run.options, run.control);
  Json json = report_of(run, report, file);
  if (!saved.meshes().empty()) json["resumed_at"] = report.resumed_at;
  json["iso"] = run.options.iso;
  json["inside"] = inside_of(run);
  json["notes"] = sinks.notes();
  set_report(result, text_of(json));
  sinks.deliver();
}

Label label_of(const iw_output& output) {
  const std::string text = text_of(output.label);
  const std::optional<Label> label = parse_label(text);
  if (!label) throw std::invalid_argument("label: expected a whole number of 64 bits, found '" + text + "'");
  return *label;
}

// The labels of the outputs, with their boxes from a pass over the volume.
std::vector<LabelSink> label_sinks(const VolumeRun& run, const CallOutputs& outputs) {
  std::vector<Label> labels;
  for (std::size_t n = 0; n < outputs.pointers().size(); ++n) labels.push_back(label_of(outputs[n]));
  std::vector<LabelSink> sinks;
  for (const LabelExtent& extent : find_labels(*run.opener.open(), labels, run.control.stop.get()))
    sinks.push_back({extent.label, outputs.pointers()[sinks.size()], extent.box});
  return sinks;
}

void mesh_labels_into(const VolumeRun& run, iw_output* outputs, std::size_t count, iw_result* result) {
  if (count == 0) throw std::invalid_argument("outputs: expected one for each label, found none");
  if (!component_rule(run.simplify).keeps_all())
    throw std::invalid_argument("largest and min_component do not go with labels");
  const MeshFileOptions file = run.file();
  CallOutputs sinks(outputs, count, file);
  const LabelsReport report = mesh_labels(*run.opener.open(), label_sinks(run, sinks), run.options, run.control);
  Json json = report_of(run, report.total, file);
  json["labels"] = Json::array();
  for (std::size_t n = 0; n < report.labels.size(); ++n) {
    Json entry = {{"label", Json::parse(sinks[n].label)}};
    entry.update(Json::parse(counts_json(report.labels[n])));
    entry.update(Json::parse(surface_json(report.labels[n])));
    json["labels"].push_back(std::move(entry));
  }
  json["notes"] = sinks.notes();
  set_report(result, text_of(json));
  sinks.deliver();
}

void mesh_isos_into(const VolumeRun& run, iw_output* outputs, std::size_t count, iw_result* result) {
  if (!component_rule(run.simplify).keeps_all())
    throw std::invalid_argument("largest and min_component do not go with several iso-values");
  const MeshFileOptions file = run.file();
  CallOutputs sinks(outputs, count, file);
  std::vector<IsoSink> surfaces;
  for (std::size_t n = 0; n < count; ++n) surfaces.push_back({sinks[n].iso, sinks.pointers()[n]});
  const IsoValuesReport report = mesh_iso_values(*run.opener.open(), surfaces, run.options, run.control);
  Json json = report_of(run, report.total, file);
  json["inside"] = inside_of(run);
  json["isos"] = Json::array();
  for (std::size_t n = 0; n < count; ++n) {
    Json entry = {{"iso", surfaces[n].iso}};
    entry.update(Json::parse(counts_json(report.meshes[n])));
    entry["notes"] = surfaces[n].sink->notes();
    entry.update(Json::parse(surface_json(report.meshes[n])));
    json["isos"].push_back(std::move(entry));
  }
  set_report(result, text_of(json));
  sinks.deliver();
}

void simplify_into(TriangleMesh mesh, const iw_simplify_options& given, const RunControl& control, iw_output* outputs,
                   std::size_t count, iw_result* result) {
  SimplifyOptions options = simplify_options(given, {mesh.unit, box_diagonal(mesh)}, "");
  MeshFileOptions file;
  file.values = !mesh.values.empty();
  file.unit = mesh.unit;
  file.space = mesh.space;
  file.offset = mesh.offset;
  file.comments = {"isoweave " ISOWEAVE_VERSION};
  CallOutputs sinks(outputs, count, file);
  const ComponentRule rule = component_rule(given);
  DroppedComponents dropped;
  if (!rule.keeps_all()) dropped = keep_components(mesh, rule);
  if (std::isinf(options.error.value) && given.error == nullptr) options.error = Length::units(most_shape_error(mesh));
  MeshReport report = simplify_mesh(mesh, sinks.pointers(), options, control);
  report.components_dropped = dropped.components;
  report.triangles_dropped = dropped.triangles;
  report.triangles_extracted += dropped.triangles;
  report.vertices_extracted += dropped.vertices;
  Json json = run_json(report, {{"triangles", report.triangles_extracted},
                                {"vertices", report.vertices_extracted},
                                {"unit", mesh.unit},
                                {"space", mesh.space},
                                {"offset", mesh.offset}});
  json["notes"] = sinks.notes();
  set_report(result, text_of(json));
  sinks.deliver();
}

}  // namespace
}  // namespace isoweave::capi

using namespace isoweave;        // NOLINT(google-build-using-namespace): the C interface has none
using namespace isoweave::capi;  // NOLINT(google-build-using-namespace)

iw_status iw_mesh_volume(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_output* outputs,
                         size_t count, iw_result* result) {
  return guarded(result, [&] {
    VolumeRun all(volume, options, run);
    mesh_into(all, outputs, count, result);
  });
}

iw_status iw_mesh_labels(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_output* outputs,
                         size_t count, iw_result* result) {
  return guarded(result, [&] { mesh_labels_into(VolumeRun(volume, options, run), outputs, count, result); });
}

iw_status iw_mesh_isos(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_output* outputs,
                       size_t count, iw_result* result) {
  return guarded(result, [&] { mesh_isos_into(VolumeRun(volume, options, run), outputs, count, result); });
}

iw_status iw_simplify_mesh(const iw_mesh* mesh, const iw_simplify_options* options, const iw_run* run,
                           iw_output* outputs, size_t count, iw_result* result) {
  return guarded(result, [&] {
    TriangleMesh copy;
    simplify_into(triangle_mesh(required(mesh, "mesh"), copy), taken(options), run_control(taken(run)), outputs, count,
                  result);
  });
}

iw_status iw_forecast(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_result* result) {
  return guarded(result, [&] {
    VolumeRun all(volume, options, run);
    all.pass_before();
    all.control.checkpoint = {};
    set_report(result, forecast_json(forecast_mesh(*all.opener.open(), all.options, all.control)));
  });
}
