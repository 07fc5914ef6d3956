// Text of others in our messages.
#pragma once

#include <string>
#include <string_view>

namespace isoweave {

// Text from a file or a path as it may appear in a one-line message: control characters become '?',
// and long text is cut.
std::string printable(std::string_view text);

// The first characters of a text, printable, in single quotes.
std::string quoted(std::string_view text);

}  // namespace isoweave
