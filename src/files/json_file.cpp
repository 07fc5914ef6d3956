#include "files/json_file.hpp"

#include <cmath>
#include <limits>

#include "files/input_file.hpp"

namespace isoweave {

namespace {

constexpr std::uint64_t kLargest = 16 << 20;

Json parse_json(std::string_view text, const std::string& path) {
  constexpr int kDeepest = 100;
  bool too_deep = false;
  const auto look = [&too_deep](int depth, Json::parse_event_t, const Json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  Json json = Json::parse(text, look, false);
  if (too_deep) bad_input(path, "JSON of at most " + std::to_string(kDeepest) + " levels", "more");
  if (text.empty()) bad_input(path, "JSON", "an empty file");
  if (json.is_discarded()) bad_input(path, "JSON", "other text, or a damaged file");
  return json;
}

}  // namespace

ObjectPart json_object(const std::string& path) { return {path, 0, kLargest, true}; }

std::optional<Json> look_for_json(ObjectStore& store, const std::string& path) {
  const std::optional<std::vector<std::byte>> bytes = store.look_for(json_object(path));
  if (!bytes) return std::nullopt;
  return parse_json({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path);
}

const Json* member(const Json& json, std::string_view key) {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(key);
  return found == json.end() ? nullptr : &*found;
}

std::string text_member(const Json& json, std::string_view key) {
  const Json* value = member(json, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

std::optional<std::int64_t> integer_of(const Json& json) {
  if (json.is_number_unsigned()) {
    const auto value = json.get<std::uint64_t>();
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return std::nullopt;
    return static_cast<std::int64_t>(value);
  }
  if (json.is_number_integer()) return json.get<std::int64_t>();
  return std::nullopt;
}

std::vector<std::int64_t> integers_member(const Json& json, std::string_view key, const std::string& path) {
  const std::string expected = "a list of integers as '" + std::string(key) + "'";
  const Json* list = member(json, key);
  if (list == nullptr || !list->is_array()) bad_input(path, expected, list == nullptr ? "none" : "something else");
  std::vector<std::int64_t> values;
  for (const Json& entry : *list) {
    const std::optional<std::int64_t> value = integer_of(entry);
    if (!value) bad_input(path, expected, "another entry");
    values.push_back(*value);
  }
  return values;
}

std::optional<std::vector<double>> numbers_of(const Json* json) {
  if (json == nullptr || !json->is_array()) return std::nullopt;
  std::vector<double> values;
  for (const Json& entry : *json) {
    if (!entry.is_number() || !std::isfinite(entry.get<double>())) return std::nullopt;
    values.push_back(entry.get<double>());
  }
  return values;
}

}  // namespace isoweave
