// The state of the processor that floating-point results depend on.
#pragma once

#include <cfenv>
#include <cfloat>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#ifdef __FAST_MATH__
#error "isoweave: results depend on IEEE 754; expected a compiler without -ffast-math"
#endif
static_assert(FLT_EVAL_METHOD == 0, "results depend on rounding to the type of each operation");

namespace isoweave {

// Sets rounding to nearest, and keeps small numbers as they are, for the lifetime of the object. Restores the caller's
// state afterwards: a host program may have set another rounding, or that small numbers are taken for 0.
class StandardFloats {
 public:
  StandardFloats() {
    std::fegetenv(&found_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~StandardFloats() { std::fesetenv(&found_); }
  StandardFloats(const StandardFloats&) = delete;
  StandardFloats& operator=(const StandardFloats&) = delete;

 private:
  std::fenv_t found_{};
};

// Whether the calling thread is known to compute as StandardFloats has it. On x86 to look is fast, and to set is slow;
// elsewhere nothing is known.
inline bool has_standard_floats() {
#ifdef __SSE2__
  constexpr unsigned kFlags = 0x3f;  // of what has happened, which no result depends on
  constexpr unsigned kDefault = 0x1f80;
  return (_mm_getcsr() & ~kFlags) == kDefault && std::fegetround() == FE_TONEAREST;
#else
  return false;
#endif
}

}  // namespace isoweave
