// Numbers that DICOM keeps as text, between backslashes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace isoweave {

// The numbers of a text, all finite; those in front of the first part that is none.
std::vector<double> leading_numbers(std::string_view text);

// How many decimals the number at a place of a text is written with, without zeros behind; many where it has an
// exponent.
int decimals_of(std::string_view text, std::size_t place);

// Throws BadInput that names `path` and `what` unless the text is `count` numbers.
std::vector<double> numbers_of(const std::string& text, std::string_view what, std::size_t count,
                               const std::string& path);

// The number that a text is; `otherwise` where it is empty.
double number_or(const std::string& text, double otherwise, std::string_view what, const std::string& path);

}  // namespace isoweave
