// Data in a page.
#pragma once

#include <string>
#include <string_view>

#include "report/report.hpp"

namespace isoweave::cli {

// The mark in a page built from viewer/ that data take the place of.
inline constexpr std::string_view kPageMark = "%%data%%";

// A script element of JSON up to its text.
std::string script_start(std::string_view id);
inline constexpr std::string_view kScriptEnd = "</script>\n";

// JSON as text that cannot end the script element around it.
std::string script_text(const Json& json);

}  // namespace isoweave::cli
