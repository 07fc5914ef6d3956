#include "volume/formats/medical/type_codes.hpp"

#include <array>
#include <string>

#include "files/input_file.hpp"

namespace isoweave {
namespace {

constexpr std::array<TypeCode, 8> kOfAnalyze{{{1, std::nullopt, "1 bit"},
                                              {2, SampleType::kUint8},
                                              {4, SampleType::kInt16},
                                              {8, SampleType::kInt32},
                                              {16, SampleType::kFloat32},
                                              {32, std::nullopt, "complex64"},
                                              {64, SampleType::kFloat64},
                                              {128, std::nullopt, "RGB"}}};

const TypeCode* find(std::int64_t code, std::span<const TypeCode> codes) {
  for (const TypeCode& one : codes) {
    if (one.code == code) return &one;
  }
  return nullptr;
}

}  // namespace

SampleType type_of_code(std::int64_t code, const TypeCodes& codes, std::string_view path) {
  const TypeCode* known = find(code, kOfAnalyze);
  if (known == nullptr) known = find(code, codes.added);
  if (known != nullptr && known->type) return *known->type;
  const std::string name = known != nullptr ? std::string(known->name) : "code " + std::to_string(code);
  bad_input(path, codes.expected, std::string(codes.format) + " type " + name);
}

}  // namespace isoweave
