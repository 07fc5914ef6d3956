// The numbers in the names of slice files: which of them are left out, and which occur twice.
#pragma once

#include <string>
#include <vector>

namespace isoweave {

// Notes about the numbers that count the slices, from the names in natural order. Nothing is said where most numbers do
// not follow one another at one step, as in dates and random names.
std::vector<std::string> notes_on_numbers(const std::vector<std::string>& files);

}  // namespace isoweave
