#include "files/from_chars.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include "files/header_text.hpp"

namespace isoweave {
namespace {

template <class Real>
concept ParsedByLibrary = requires(const char* text, Real& value) {
  std::from_chars(text, text, value);
};

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

// The number that a stream reads from a whole decimal number without a sign. Nothing where the type has none near: it
// is too large, or would be 0 and is not. A stream may fail at a number that it reads well, one that is below the
// normal ones.
template <class Real>
std::optional<Real> read_decimal(std::string_view text) {
  std::istringstream in{std::string(text)};
  in.imbue(std::locale::classic());
  Real number = 0;
  in >> number;
  const std::string_view digits = text.substr(0, text.find_first_of("eE"));
  const bool is_zero = digits.find_first_not_of("0.") == std::string_view::npos;
  const bool fits = number == 0 ? is_zero : in || number < 1;
  return fits ? std::optional(number) : std::nullopt;
}

template <class Real>
std::from_chars_result parse_by_stream(const char* first, const char* last, Real& value) {
  const bool negative = first != last && *first == '-';
  const char* const begin = negative ? first + 1 : first;
  const std::string_view text(begin, static_cast<std::size_t>(last - begin));
  const auto give = [&](Real number, std::size_t used) {
    value = negative ? -number : number;
    return std::from_chars_result{begin + used, std::errc{}};
  };
  for (const std::string_view name : {"infinity", "inf", "nan"}) {
    if (lower_case(text.substr(0, name.size())) != name) continue;
    constexpr auto kNot = std::numeric_limits<Real>::quiet_NaN();
    return give(name == "nan" ? kNot : std::numeric_limits<Real>::infinity(), name.size());
  }
  const std::size_t used = count_decimal(text);
  if (used == 0) return {first, std::errc::invalid_argument};
  const std::optional<Real> number = read_decimal<Real>(text.substr(0, used));
  if (!number) return {begin + used, std::errc::result_out_of_range};
  return give(*number, used);
}

template <class Real>
std::from_chars_result parse(const char* first, const char* last, Real& value) {
  if constexpr (ParsedByLibrary<Real>) {
    return std::from_chars(first, last, value);
  } else {
    return parse_by_stream(first, last, value);
  }
}

}  // namespace

std::from_chars_result number_from_chars(const char* first, const char* last, double& value) {
  return parse(first, last, value);
}

std::from_chars_result number_from_chars(const char* first, const char* last, float& value) {
  return parse(first, last, value);
}

std::from_chars_result number_from_chars_by_stream(const char* first, const char* last, double& value) {
  return parse_by_stream(first, last, value);
}

std::from_chars_result number_from_chars_by_stream(const char* first, const char* last, float& value) {
  return parse_by_stream(first, last, value);
}

}  // namespace isoweave
