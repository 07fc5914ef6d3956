// Man pages and completions of shells, from the options as help shows them.
#pragma once

#include <string>

#include "options/cli_app.hpp"

namespace isoweave::cli {

// The man page of the program or of one verb, in roff.
std::string man_page(const CLI::App& app);

// A script that completes verbs and options: for "bash", "zsh" or "fish".
// Throws std::invalid_argument for another shell.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace isoweave::cli
