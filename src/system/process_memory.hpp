// Memory that the process takes, as the system counts it.
#pragma once

#include <cstdint>

namespace isoweave::system {

// The bytes in physical memory now, and the most until now; 0 where the system does not tell.
std::uint64_t resident_bytes();
std::uint64_t peak_bytes();

}  // namespace isoweave::system
