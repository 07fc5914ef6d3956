#include "capi/json_reports.hpp"

#include <optional>
#include <utility>

namespace isoweave::capi {

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace); }

Json histogram_json(const Histogram& histogram) {
  const std::optional<double> iso = otsu_threshold(histogram);
  return {{"min", histogram.empty() ? Json(nullptr) : Json(histogram.min)},
          {"max", histogram.empty() ? Json(nullptr) : Json(histogram.max)},
          {"nan", histogram.nan},
          {"infinite", histogram.infinite},
          {"histogram", histogram.bins},
          {"suggested_iso", iso ? Json(*iso) : Json(nullptr)}};
}

Json labels_json(std::span<const LabelExtent> labels) {
  Json list = Json::array();
  for (const LabelExtent& label : labels)
    list.push_back({{"label", Json::parse(label.label.text())}, {"samples", label.samples}});
  return list;
}

Json run_json(const MeshReport& report, Json input) {
  Json json = Json::parse(isoweave::run_json(report));
  json["input"] = std::move(input);
  for (const SurfaceReport& level : report.levels) json["levels"].push_back(Json::parse(surface_json(level)));
  return json;
}

const char* extractor_name(ExtractorKind extractor) {
  switch (extractor) {
    case ExtractorKind::kTrilinear:
      return "trilinear";
    case ExtractorKind::kTetrahedra:
      return "tetrahedra";
    case ExtractorKind::kDual:
      return "dual";
    case ExtractorKind::kCubes:
      break;
  }
  return "cubes";
}

}  // namespace isoweave::capi
