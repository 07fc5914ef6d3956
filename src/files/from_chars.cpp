#include "files/from_chars.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include "files/header_text.hpp"

namespace isoweave {
namespace {

template <class Number>
concept ParsedByLibrary = requires(const char* text, Number& value) {
  std::from_chars(text, text, value);
};

template <class Number>
std::from_chars_result parse(const char* first, const char* last, Number& value) {
  if constexpr (ParsedByLibrary<Number>) {
    return std::from_chars(first, last, value);
  } else {
    return double_from_chars_by_stream(first, last, value);
  }
}

std::size_t count_digits(std::string_view text) { return std::min(text.find_first_not_of("0123456789"), text.size()); }

// How much of a text is a decimal number without a sign: digits, a point among them, perhaps an exponent.
std::size_t count_decimal(std::string_view text) {
  std::size_t end = count_digits(text);
  std::size_t digits = end;
  if (end < text.size() && text[end] == '.') {
    const std::size_t behind = count_digits(text.substr(end + 1));
    digits += behind;
    end += digits > 0 ? 1 + behind : 0;
  }
  if (digits == 0 || end == text.size() || (text[end] != 'e' && text[end] != 'E')) return end;
  const std::size_t sign = end + 1 < text.size() && (text[end + 1] == '-' || text[end + 1] == '+') ? 1 : 0;
  const std::size_t exponent = count_digits(text.substr(end + 1 + sign));
  return exponent > 0 ? end + 1 + sign + exponent : end;
}

}  // namespace

std::from_chars_result double_from_chars(const char* first, const char* last, double& value) {
  return parse(first, last, value);
}

std::from_chars_result double_from_chars_by_stream(const char* first, const char* last, double& value) {
  const bool negative = first != last && *first == '-';
  const char* const begin = negative ? first + 1 : first;
  const std::string_view text(begin, static_cast<std::size_t>(last - begin));
  const auto give = [&](double number, std::size_t used) {
    value = negative ? -number : number;
    return std::from_chars_result{begin + used, std::errc{}};
  };
  for (const std::string_view name : {"infinity", "inf", "nan"}) {
    if (lower_case(text.substr(0, name.size())) != name) continue;
    constexpr auto kNot = std::numeric_limits<double>::quiet_NaN();
    return give(name == "nan" ? kNot : std::numeric_limits<double>::infinity(), name.size());
  }
  const std::size_t used = count_decimal(text);
  if (used == 0) return {first, std::errc::invalid_argument};
  std::istringstream in{std::string(text.substr(0, used))};
  in.imbue(std::locale::classic());
  double number = 0;
  if (!(in >> number)) return {begin + used, std::errc::result_out_of_range};
  return give(number, used);
}

}  // namespace isoweave
