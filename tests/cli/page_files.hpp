// Looks into pages that isoweave has written.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace isoweave::pages {

// The JSON of the script element with this id; null where there is none. Fails the test where the text does not parse.
nlohmann::json json_in(const std::string& page, const std::string& id);

std::size_t occurrences(const std::string& text, const std::string& part);

// A surface of a page in whole steps, and the distances as stored.
struct Surface {
  std::array<double, 3> origin{};
  double step = 0;
  std::vector<std::array<std::uint16_t, 4>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Surface unpacked(const nlohmann::json& packed);

}  // namespace isoweave::pages
