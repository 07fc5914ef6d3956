#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "isoweave/pipeline.hpp"

namespace isoweave {
namespace {

struct Unit {
  std::string_view name;
  double millimetres;
};

constexpr std::array<Unit, 5> kUnits{{{"mm", 1}, {"um", 1e-3}, {"nm", 1e-6}, {"cm", 10}, {"m", 1e3}}};

double millimetres(std::string_view unit) {
  if (unit.empty()) return 1;
  for (const Unit& known : kUnits) {
    if (known.name == unit) return known.millimetres;
  }
  return 0;
}

}  // namespace

Length parse_length(std::string_view text, std::string_view unit) {
  double value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view suffix(end, static_cast<std::size_t>(text.data() + text.size() - end));
  const bool known = suffix.empty() || suffix == "vox" || (millimetres(suffix) > 0 && millimetres(unit) > 0);
  if (failed != std::errc{} || !(value >= 0) || std::isinf(value) || !known) {
    throw std::invalid_argument("length '" + std::string(text) +
                                "': expected a number of 0 or more and vox, mm, um, nm or nothing");
  }
  if (suffix == "vox") return {value, true};
  if (suffix.empty()) return {value, false};
  return {value * millimetres(suffix) / millimetres(unit), false};
}

}  // namespace isoweave
