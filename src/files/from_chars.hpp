// std::from_chars of any number, also by standard libraries that have it for whole numbers only (libc++ before 20).
#pragma once

#include <charconv>
#include <concepts>

namespace isoweave {

std::from_chars_result number_from_chars(const char* first, const char* last, double& value);
std::from_chars_result number_from_chars(const char* first, const char* last, float& value);

template <std::integral Whole>
std::from_chars_result number_from_chars(const char* first, const char* last, Whole& value) {
  return std::from_chars(first, last, value);
}

// The replacement for the standard library's function, for tests of it.
std::from_chars_result number_from_chars_by_stream(const char* first, const char* last, double& value);
std::from_chars_result number_from_chars_by_stream(const char* first, const char* last, float& value);

}  // namespace isoweave
