#include "volume/xml_tag.hpp"

#include <array>
#include <utility>

namespace isoweave {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string without_entities(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};
  std::string result;
  while (!text.empty()) {
    std::string_view used = text.substr(0, 1);
    char shown = text[0];
    for (const auto& [entity, character] : kEntities) {
      if (!text.starts_with(entity)) continue;
      used = entity;
      shown = character;
    }
    result += shown;
    text.remove_prefix(used.size());
  }
  return result;
}

}  // namespace

std::string xml_attribute(std::string_view tag, std::string_view name) {
  // Attribute by attribute, so that a name inside a value is not taken for one.
  std::size_t at = tag.find_first_of(kBlanks);
  while (at < tag.size()) {
    at = tag.find_first_not_of(kBlanks, at);
    if (at == std::string_view::npos) return {};
    const std::size_t equals = tag.find('=', at);
    const std::size_t open = equals == std::string_view::npos ? equals : tag.find_first_of("\"'", equals);
    if (open == std::string_view::npos) return {};
    const std::size_t close = tag.find(tag[open], open + 1);
    if (close == std::string_view::npos) return {};
    const std::string_view written = tag.substr(at, equals - at);
    if (written.substr(0, written.find_first_of(kBlanks)) == name) {
      return without_entities(tag.substr(open + 1, close - open - 1));
    }
    at = close + 1;
  }
  return {};
}

}  // namespace isoweave
