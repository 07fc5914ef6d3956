// The table of all options for help, man pages and completions: the group in which each stands and the kind of its
// value.
#pragma once

#include <string>
#include <vector>

#include "options/cli_app.hpp"

namespace isoweave::cli {

// Gives every option of the verb its group and the name of its value.
void describe_options(CLI::App& verb);

// The groups, in the order in which help shows them.
const std::vector<std::string>& option_groups();

// The words behind "isoweave VERB" in its usage: "VOLUME -o MESH --iso VALUE [options]".
std::string usage_text(const std::string& verb);

}  // namespace isoweave::cli
