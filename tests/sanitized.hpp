// Whether a sanitizer watches. It takes memory of its own and makes every run five to fifteen times slower: tests show
// it the same code on fewer combinations.
#pragma once

namespace isoweave::testing {

#ifdef ISOWEAVE_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace isoweave::testing
