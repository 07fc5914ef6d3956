// Text of others in our messages, told from ours by quotes.
#pragma once

#include <string>
#include <string_view>

namespace isoweave {

// The first characters of a text, printable, in single quotes.
std::string in_quotes(std::string_view text);

}  // namespace isoweave
