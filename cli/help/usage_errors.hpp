// Usage errors that say what to do: the help of their verb, the option that was meant, what is missing.
#pragma once

#include <string>
#include <vector>

#include "options/cli_app.hpp"

namespace isoweave::cli {

// The known name that is nearest to a mistyped one, or nothing where none is near.
std::string nearest(const std::string& name, const std::vector<std::string>& known);

// The advice about an option that the verb does not have; empty where it has all of them.
std::string unknown_option(const CLI::App& verb, const std::vector<std::string>& arguments);

// The advice about arguments that a verb has no place for.
std::string extra_text(const CLI::App& verb, const std::vector<std::string>& arguments);

// The message about an option that has too many values or none, out of CLI11's.
std::string mismatch_text(const std::string& message);

// CLI11's message about a missing option or value, with an example of what to give.
std::string missing_text(const std::string& message);

}  // namespace isoweave::cli
