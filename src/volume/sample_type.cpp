// Names and sizes of the sample types.
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "isoweave/volume.hpp"

namespace isoweave {
namespace {

struct TypeFacts {
  SampleType type;
  std::string_view name;
  std::size_t bytes;
};

// In the order of the enumeration.
constexpr std::array<TypeFacts, 10> kTypes{{{SampleType::kUint8, "uint8", 1},
                                            {SampleType::kInt8, "int8", 1},
                                            {SampleType::kUint16, "uint16", 2},
                                            {SampleType::kInt16, "int16", 2},
                                            {SampleType::kUint32, "uint32", 4},
                                            {SampleType::kInt32, "int32", 4},
                                            {SampleType::kUint64, "uint64", 8},
                                            {SampleType::kInt64, "int64", 8},
                                            {SampleType::kFloat32, "float32", 4},
                                            {SampleType::kFloat64, "float64", 8}}};

}  // namespace

std::size_t sample_bytes(SampleType type) { return kTypes.at(static_cast<std::size_t>(type)).bytes; }

std::string_view sample_type_name(SampleType type) { return kTypes.at(static_cast<std::size_t>(type)).name; }

std::optional<SampleType> parse_sample_type(std::string_view name) {
  for (const TypeFacts& facts : kTypes) {
    if (facts.name == name) return facts.type;
  }
  return std::nullopt;
}

std::string_view space_name(Space space) {
  switch (space) {
    case Space::kLps:
      return "lps";
    case Space::kRas:
      return "ras";
    case Space::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace isoweave
