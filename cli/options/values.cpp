#include "options/values.hpp"

#include <algorithm>
#include <cmath>

namespace isoweave::cli {
namespace {

constexpr std::int64_t kMostThreads = 4096;

std::optional<double> to_finite(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const std::optional<double> value = to_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

void wrong_value(std::string_view option, std::string_view expected, std::string_view found) {
  throw std::invalid_argument(fmt::format("{}: expected {}, found '{}'", option, expected, found));
}

double parse_number(std::string_view option, std::string_view text) {
  const std::optional<double> value = to_finite(text);
  if (!value) wrong_value(option, "a number", text);
  return *value;
}

double parse_share(std::string_view option, std::string_view text) {
  constexpr double kPercent = 0.01;
  std::string_view digits = text;
  const bool percent = digits.ends_with('%');
  if (percent) digits.remove_suffix(1);
  const std::optional<double> value = to_finite(digits);
  if (!value) wrong_value(option, "a number or a percentage", text);
  return *value * (percent ? kPercent : 1);
}

std::int64_t parse_count(std::string_view option, std::string_view text, std::string_view example) {
  constexpr double kMost = 9e18;
  std::string_view digits = text;
  double factor = 1;
  if (digits.ends_with('k') || digits.ends_with('K')) factor = 1e3;
  if (digits.ends_with('M')) factor = 1e6;
  if (factor > 1) digits.remove_suffix(1);
  const std::optional<std::int64_t> value = to_number<std::int64_t>(digits);
  if (value && *value >= 1 && factor == 1) return *value;
  const std::optional<double> part = to_finite(digits);
  const bool whole = part && factor > 1 && *part * factor >= 1 && *part * factor < kMost &&
                     std::floor(*part * factor) == *part * factor;
  if (!whole) {
    const std::string hint = to_finite(text) ? "" : fmt::format(", such as {}", example);
    wrong_value(option, "a whole number of at least 1" + hint, text);
  }
  return static_cast<std::int64_t>(*part * factor);
}

int parse_port(std::string_view option, std::string_view text) {
  const std::optional<std::uint16_t> port = to_number<std::uint16_t>(text);
  if (!port) wrong_value(option, "a port from 1 to 65535, or 0 for any that is free", text);
  return *port;
}

std::uint64_t parse_bytes(std::string_view option, std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 9> kUnits{{{"", 1},
                                                                       {"K", 1e3},
                                                                       {"M", 1e6},
                                                                       {"G", 1e9},
                                                                       {"T", 1e12},
                                                                       {"Ki", 1024.0},
                                                                       {"Mi", 1024.0 * 1024},
                                                                       {"Gi", 1024.0 * 1024 * 1024},
                                                                       {"Ti", 1024.0 * 1024 * 1024 * 1024}}};
  std::string_view unit = text.substr(std::min(text.find_first_not_of("0123456789."), text.size()));
  const std::optional<double> number = to_finite(text.substr(0, text.size() - unit.size()));
  if (unit.ends_with('B')) unit.remove_suffix(1);
  for (const auto& [name, bytes] : kUnits) {
    if (name == unit && number && *number * bytes >= 1 && *number * bytes < 1e18) {
      return static_cast<std::uint64_t>(*number * bytes);
    }
  }
  wrong_value(option, "an amount of memory such as 800M or 2G", text);
}

std::array<double, 3> parse_triple(std::string_view option, std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  std::array<double, 3> values{};
  if (parts.size() != values.size()) wrong_value(option, "three numbers x,y,z", text);
  for (std::size_t axis = 0; axis < values.size(); ++axis) {
    const std::optional<double> value = to_finite(parts[axis]);
    if (!value) wrong_value(option, "three numbers x,y,z", text);
    values[axis] = *value;
  }
  return values;
}

std::array<double, 3> parse_spacing(std::string_view option, std::string_view text) {
  const std::optional<double> all = to_finite(text);
  if (all) return {*all, *all, *all};
  return parse_triple(option, text);
}

std::string type_name(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 21> kNames{
      {{"u8", "uint8"},   {"i8", "int8"},     {"u16", "uint16"},    {"i16", "int16"},      {"u32", "uint32"},
       {"i32", "int32"},  {"u64", "uint64"},  {"i64", "int64"},     {"f32", "float32"},    {"f64", "float64"},
       {"byte", "uint8"}, {"uchar", "uint8"}, {"char", "int8"},     {"short", "int16"},    {"ushort", "uint16"},
       {"int", "int32"},  {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}, {"s16", "int16"},
       {"s8", "int8"}}};
  for (const auto& [name, known] : kNames) {
    if (name == text) return std::string(known);
  }
  return std::string(text);
}

std::array<std::int64_t, 3> parse_size(std::string_view option, std::string_view text) {
  std::vector<std::string_view> parts = split(text, 'x');
  if (parts.size() == 1) parts.assign(3, parts[0]);
  std::array<std::int64_t, 3> dims{};
  if (parts.size() != dims.size()) wrong_value(option, "WxHxD with sides of at least 1", text);
  for (std::size_t axis = 0; axis < dims.size(); ++axis) {
    const std::optional<std::int64_t> side = to_number<std::int64_t>(parts[axis]);
    if (!side || *side < 1) wrong_value(option, "WxHxD with sides of at least 1", text);
    dims[axis] = *side;
  }
  return dims;
}

Quality parse_quality(std::string_view text) {
  return parse_choice<Quality>("--quality", text,
                               {{"fast", Quality::kFast}, {"normal", Quality::kNormal}, {"fine", Quality::kFine}});
}

int parse_threads(std::string_view text) {
  if (text == "all") return 0;
  const std::int64_t threads = parse_count("--threads", text, "8, or all");
  if (threads > kMostThreads) wrong_value("--threads", fmt::format("at most {}", kMostThreads), text);
  return static_cast<int>(threads);
}

}  // namespace isoweave::cli
