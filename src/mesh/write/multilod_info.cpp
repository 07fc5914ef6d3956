#include "mesh/write/multilod_info.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "files/length_units.hpp"

namespace isoweave {

std::string multilod_info(const MeshFileOptions& options, unsigned minishard_bits, const std::string& properties) {
  const double scale = unit_in(unit_or_usual(options.unit), "nm").value_or(1);
  nlohmann::ordered_json info{{"@type", "neuroglancer_multilod_draco"},
                              {"vertex_quantization_bits", 16},
                              {"transform",
                               {scale, 0, 0, scale * options.offset[0], 0, scale, 0, scale * options.offset[1], 0, 0,
                                scale, scale * options.offset[2]}},
                              {"lod_scale_multiplier", 1},
                              {"sharding",
                               {{"@type", "neuroglancer_uint64_sharded_v1"},
                                {"preshift_bits", 0},
                                {"hash", minishard_bits == 0 ? "identity" : "murmurhash3_x86_128"},
                                {"minishard_bits", minishard_bits},
                                {"shard_bits", 0},
                                {"minishard_index_encoding", "raw"},
                                {"data_encoding", "raw"}}}};
  if (!properties.empty()) info["segment_properties"] = properties;
  return info.dump() + "\n";
}

std::string multilod_rounding(const std::string& path, const std::string& unit, double error, std::size_t coarsest) {
  std::ostringstream text;
  text.precision(3);
  text << path << ": positions were rounded to 1/65535 of the side of a fragment, by at most " << error;
  if (!unit.empty()) text << ' ' << unit;
  if (coarsest > 0) {
    text << "; level " << coarsest << ", the coarsest, by " << (std::uint64_t{1} << coarsest) << " times that";
  }
  return text.str();
}

std::vector<std::string> multilod_unit_notes(const std::string& path, const std::string& unit) {
  if (!unit.empty()) return {};
  return {path + ": the unit is not said, coordinates were taken for mm"};
}

}  // namespace isoweave
