// Messages about memory caps, in one unit.
#pragma once

#include <cstdint>
#include <string>

namespace isoweave {

inline constexpr double kLastPart = 0.92;    // of a cap, what a slab of one layer may take
inline constexpr double kNamedMargin = 1.5;  // the zone may still grow
inline constexpr double kRingPart = 0.05;    // of a cap, slices in the ring beyond those of one layer

// Throws OverMemory "WHERE: expected --memory 151M or more, found 150M": `least` bytes is the smallest cap that should
// do. K and M are powers of 1000.
[[noreturn]] void refuse_cap(const std::string& where, std::uint64_t least, std::uint64_t cap,
                             const std::string& more = {});

// A cap as users write it: in the largest unit in which it is a whole number.
std::string cap_text(std::uint64_t bytes);

// The cap that a message names for a forecast. It is larger than the forecast, as that is a guess and the named cap
// must do: two processes differ by some megabytes, and the process that gets this cap makes a forecast of its own.
// Smaller caps are tried, down to the forecast.
std::uint64_t with_slack(std::uint64_t least);
std::uint64_t without_slack(std::uint64_t named);

// The smallest cap of whole megabytes that holds so many bytes.
std::uint64_t whole_cap(std::uint64_t bytes);

}  // namespace isoweave
