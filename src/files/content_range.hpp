// The header by which a server says which part of an object it sends.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace isoweave {

struct ContentRange {
  std::uint64_t first = 0, last = 0;
  std::optional<std::uint64_t> size{};  // of the whole object; nothing where the server does not know
};

// Reads "bytes FIRST-LAST/SIZE", where SIZE may be "*"; nothing for any other text, and for ranges that are none.
std::optional<ContentRange> parse_content_range(std::string_view text);

}  // namespace isoweave
