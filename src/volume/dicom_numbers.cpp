#include "volume/dicom_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "volume/header_text.hpp"
#include "volume/input_file.hpp"
#include "volume/printable.hpp"

namespace isoweave {

std::vector<double> leading_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    const auto number = parse_double(trimmed(text.substr(at, end - at)));
    if (!number || !std::isfinite(*number)) break;
    numbers.push_back(*number);
    at = end + 1;
  }
  return numbers;
}

std::vector<double> numbers_of(const std::string& text, std::string_view what, std::size_t count,
                               const std::string& path) {
  std::vector<double> numbers = leading_numbers(text);
  if (numbers.size() != count) {
    bad_input(path, std::to_string(count) + " numbers as " + std::string(what), text.empty() ? "none" : quoted(text));
  }
  return numbers;
}

double number_or(const std::string& text, double otherwise, std::string_view what, const std::string& path) {
  return text.empty() ? otherwise : numbers_of(text, what, 1, path)[0];
}

}  // namespace isoweave
