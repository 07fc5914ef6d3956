#include "files/content_range.hpp"

#include "files/from_chars.hpp"
#include "files/header_text.hpp"

namespace isoweave {
namespace {

// Takes a number off the text.
std::optional<std::uint64_t> take_number(std::string_view& text) {
  std::uint64_t number = 0;
  const auto [end, error] = number_from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

}  // namespace

std::optional<ContentRange> parse_content_range(std::string_view text) {
  text = trimmed(text);
  if (!take(text, "bytes ")) return std::nullopt;
  const std::optional<std::uint64_t> first = take_number(text);
  if (!first || !take(text, "-")) return std::nullopt;
  const std::optional<std::uint64_t> last = take_number(text);
  if (!last || *last < *first || !take(text, "/")) return std::nullopt;
  ContentRange range{*first, *last, {}};
  if (text == "*") return range;
  range.size = take_number(text);
  if (!range.size || !text.empty() || *range.size <= *last) return std::nullopt;
  return range;
}

}  // namespace isoweave
