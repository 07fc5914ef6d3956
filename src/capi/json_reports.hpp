// The reports of the C interface: JSON, with the keys of the command line's reports.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "isoweave/forecast.hpp"
#include "isoweave/histogram.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "isoweave/volume.hpp"

namespace isoweave::capi {

using Json = nlohmann::ordered_json;

// JSON text. Names that are not UTF-8 do not stop it.
std::string text_of(const Json& json);

// The `input` part of a report: the facts of a volume's header.
Json volume_json(const VolumeInfo& info);

Json histogram_json(const Histogram& histogram);
Json labels_json(std::span<const LabelExtent> labels);

// A surface as it was written.
Json surface_json(const SurfaceReport& surface);

// A run, and its levels. `input` is the part that differs between runs on volumes and on meshes.
Json run_json(const MeshReport& report, Json input);

// The name that the command line has for it.
const char* extractor_name(ExtractorKind extractor);

// The range of the values that a run has read, for its `input`.
void add_range(const MeshReport& report, Json& input);

Json forecast_json(const Forecast& forecast);
Json check_json(const MeshCheck& check);
Json self_intersections_json(const SelfIntersections& found);
Json distances_json(const MeshDistance& distance);

}  // namespace isoweave::capi
