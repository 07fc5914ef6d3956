// The hash by which neuroglancer's numbers are spread over shards.
#pragma once

#include <cstdint>

namespace isoweave {

// The lower half of MurmurHash3_x86_128 of a number, least significant byte first, with the seed 0.
std::uint64_t murmur_hash(std::uint64_t number);

}  // namespace isoweave
