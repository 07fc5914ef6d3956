// Checks of what the code takes for granted, in builds that are made to find faults (ISOWEAVE_CHECKS): a check that
// fails is a std::logic_error that names it. Other builds have none, and so have devices.
#pragma once

#if defined(ISOWEAVE_CHECKS) && !defined(__CUDACC__)

#include <stdexcept>
#include <string>

namespace isoweave {

[[noreturn]] inline void fail_check(const char* condition, const char* file, int line) {
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": internal check failed: " + condition);
}

inline constexpr bool kChecks = true;

}  // namespace isoweave

#define ISOWEAVE_CHECK(condition) \
  (static_cast<bool>(condition) ? void() : ::isoweave::fail_check(#condition, __FILE__, __LINE__))

#else

namespace isoweave {

inline constexpr bool kChecks = false;

}  // namespace isoweave

#define ISOWEAVE_CHECK(condition) static_cast<void>(sizeof(static_cast<bool>(condition)))

#endif
