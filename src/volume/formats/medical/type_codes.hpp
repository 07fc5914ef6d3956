// The codes of sample types in headers of Analyze 7.5, and of the formats that have added their own to them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "isoweave/volume.hpp"

namespace isoweave {

// A code, and the type that it stands for. A type that is not read has a name only.
struct TypeCode {
  std::int64_t code;
  std::optional<SampleType> type;
  std::string_view name{};
};

// A format that has added codes, and the types that a volume of it is expected to have.
struct TypeCodes {
  std::string_view format;
  std::string_view expected;
  std::span<const TypeCode> added;
};

// Throws BadInput for a type that is not read.
SampleType type_of_code(std::int64_t code, const TypeCodes& codes, std::string_view path);

}  // namespace isoweave
