// Label maps: what they may be, and their samples as masks.
#pragma once

#include <cstddef>
#include <cstdint>

#include "isoweave/volume.hpp"

namespace isoweave {

// Throws BadInput unless samples are integers and are what they are stored as.
void check_label_map(const VolumeInfo& volume);

// 1 where a sample of a row is the label, else 0.
void mask_row(const std::byte* samples, SampleType type, std::int64_t count, std::int64_t label, std::uint8_t* mask);

}  // namespace isoweave
