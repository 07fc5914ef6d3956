// The reports of the C interface: JSON, with the keys of the command line's reports.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "isoweave/histogram.hpp"
#include "isoweave/pipeline.hpp"
#include "isoweave/report_json.hpp"
#include "isoweave/volume.hpp"

namespace isoweave::capi {

using Json = nlohmann::ordered_json;

// JSON text. Names that are not UTF-8 do not stop it.
std::string text_of(const Json& json);

Json histogram_json(const Histogram& histogram);
Json labels_json(std::span<const LabelExtent> labels);

// A run, and its levels. `input` is the part that differs between runs on volumes and on meshes.
Json run_json(const MeshReport& report, Json input);

// The name that the command line has for it.
const char* extractor_name(ExtractorKind extractor);

}  // namespace isoweave::capi
