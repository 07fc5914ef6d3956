// Help on a terminal: groups of options, 80 columns, defaults, examples of the verb.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "options/cli_app.hpp"

namespace isoweave::cli {

// An option as every kind of help shows it.
struct OptionEntry {
  std::string short_name, long_name;  // with dashes; either may be empty
  std::string value;                  // what its value is; empty for a flag
  std::string text;                   // what it does, with its default
};

// Positional arguments, then the options group by group; groups without options are left out.
struct OptionList {
  std::string title;
  std::vector<OptionEntry> entries;
};
std::vector<OptionList> option_lists(const CLI::App& app);

// The verbs in their order.
std::vector<const CLI::App*> verbs_of(const CLI::App& app);

// Has CLI11 print our help for the program and all verbs that are added later.
void use_help_text(CLI::App& app);

// Text in lines of at most `width` columns, all but the first after `indent` blanks.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width);

}  // namespace isoweave::cli
