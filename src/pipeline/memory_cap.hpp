// What is said of memory caps, in one unit.
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

// A cap in the form in which one is asked for: the largest unit in which it is a whole number.
std::string cap_text(std::uint64_t bytes);

// The margin of the cap that a message names over a forecast. That cap has to do, while a forecast is a guess;
// two processes differ by some megabytes, and the one that gets this cap looks again. Smaller ones are tried, down to
// what is forecast.
std::uint64_t with_slack(std::uint64_t least);
std::uint64_t without_slack(std::uint64_t named);

// The smallest cap of whole megabytes that holds so many bytes.
std::uint64_t whole_cap(std::uint64_t bytes);

}  // namespace isoweave
