#include "volume/formats/dicom/dicom_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"

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

int decimals_of(std::string_view text, std::size_t place) {
  constexpr int kMany = 99;
  for (; place > 0 && text.find('\\') != std::string_view::npos; --place) text.remove_prefix(text.find('\\') + 1);
  text = trimmed(text.substr(0, text.find('\\')));
  if (text.find_first_of("eE") != std::string_view::npos) return kMany;
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos) return 0;
  return static_cast<int>(text.find_last_not_of('0') - point);
}

std::vector<double> numbers_of(const std::string& text, std::string_view what, std::size_t count,
                               const std::string& path) {
  std::vector<double> numbers = leading_numbers(text);
  if (numbers.size() != count) {
    bad_input(path, std::to_string(count) + " numbers as " + std::string(what),
              text.empty() ? "none" : in_quotes(text));
  }
  return numbers;
}

double number_or(const std::string& text, double otherwise, std::string_view what, const std::string& path) {
  return text.empty() ? otherwise : numbers_of(text, what, 1, path)[0];
}

}  // namespace isoweave
