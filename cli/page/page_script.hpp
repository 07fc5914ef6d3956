// Data in a page.
#pragma once

#include <string>
#include <string_view>

#include "isoweave/output_file.hpp"
#include "report/report.hpp"

namespace isoweave::cli {

// The mark in a page built from viewer/ that data take the place of.
inline constexpr std::string_view kPageMark = "%%data%%";

// A script element of JSON up to its text.
std::string script_start(std::string_view id);
inline constexpr std::string_view kScriptEnd = "</script>\n";

// JSON as text that cannot end the script element around it.
std::string script_text(const Json& json);

// Writes text, and a script element of JSON.
void write_text(OutputFile& file, std::string_view text);
void write_script(OutputFile& file, std::string_view id, const Json& json);

}  // namespace isoweave::cli
