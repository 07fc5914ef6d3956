// 16-bit floats of IEEE 754. There are no samples of that type: they are read as float32, which holds all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "isoweave/volume.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// How a file keeps its samples.
struct StoredType {
  SampleType type = SampleType::kUint8;  // of a half: the integer of its bits
  bool is_half = false;

  bool operator==(const StoredType&) const = default;
};

// The name of a sample type, or "float16".
std::optional<StoredType> parse_stored_type(std::string_view name);

// "float16", or the name of the sample type.
std::string_view stored_type_name(const StoredType& type);

float float_of_half(std::uint16_t half);

// The half nearest to a value, the even one of two. Nothing for finite numbers beyond the largest half.
std::optional<std::uint16_t> half_of(float value);

// Turns a volume of uint16, the bits of halves as they are stored, into one of float32.
void read_halves(OpenedVolume& volume);

}  // namespace isoweave
