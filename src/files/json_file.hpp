// Metadata in JSON: files of bounded size and depth, and members of the types that are expected.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/object_store.hpp"

namespace isoweave {

using Json = nlohmann::json;

// The JSON of an object; nothing where the store has none of this path. Throws BadInput when it cannot be read, is
// larger than any metadata should be, or is no JSON.
std::optional<Json> look_for_json(ObjectStore& store, const std::string& path);

// The object whose JSON look_for_json() looks for, for ObjectStore::expect.
ObjectPart json_object(const std::string& path);

// The member of an object; nullptr when there is none, or `json` is no object.
const Json* member(const Json& json, std::string_view key);

// A text member; empty when there is none, or it is no text.
std::string text_member(const Json& json, std::string_view key);

// An integer that fits; nothing for any other value.
std::optional<std::int64_t> integer_of(const Json& json);

// A list of integers. Throws BadInput naming `path` and the key for anything else.
std::vector<std::int64_t> integers_member(const Json& json, std::string_view key, const std::string& path);

// A list of finite numbers; nothing for anything else.
std::optional<std::vector<double>> numbers_of(const Json* json);

}  // namespace isoweave
