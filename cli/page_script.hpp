// Data in a page.
#pragma once

#include <string>
#include <string_view>

#include "report.hpp"

namespace isoweave::cli {

// Where data go in a page as it is built from viewer/.
inline constexpr std::string_view kPageMark = "%%data%%";

// A script element of JSON up to its text.
std::string script_start(std::string_view id);
inline constexpr std::string_view kScriptEnd = "</script>\n";

// Nothing in it can end the script element that it is put in.
std::string script_text(const Json& json);

}  // namespace isoweave::cli
