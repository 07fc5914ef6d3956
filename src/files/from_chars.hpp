// std::from_chars of a double, also by standard libraries that have it for whole numbers only (libc++ before 20).
#pragma once

#include <charconv>

namespace isoweave {

std::from_chars_result double_from_chars(const char* first, const char* last, double& value);

// The replacement for the standard library's function, for tests of it.
std::from_chars_result double_from_chars_by_stream(const char* first, const char* last, double& value);

}  // namespace isoweave
