#include "help/manual.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "help/help_text.hpp"
#include "help/option_table.hpp"
#include "options/values.hpp"

namespace isoweave::cli {
namespace {

// Text for roff: no hyphen becomes a dash, no line begins with a command.
std::string roff(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if (c == '\'' && (escaped.empty() || escaped.back() == '\n')) {
      escaped += "\\(aq";
    } else if (c == '.' && (escaped.empty() || escaped.back() == '\n')) {
      escaped += "\\&.";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string roff_entry(const OptionEntry& entry) {
  std::string names = entry.short_name.empty() ? "" : "\\fB" + roff(entry.short_name) + "\\fR";
  if (!entry.long_name.empty()) {
    names += (names.empty() ? "" : ", ") + std::string("\\fB") + roff(entry.long_name) + "\\fR";
  }
  if (!entry.value.empty()) names += (names.empty() ? "" : " ") + std::string("\\fI") + roff(entry.value) + "\\fR";
  return fmt::format(".TP\n{}\n{}\n", names, roff(entry.text));
}

// A text for quotes of zsh and fish.
std::string plain(std::string_view text) {
  std::string kept;
  for (const char c : text) {
    if (c == '\'' || c == '[' || c == ']' || c == ':' || c == '\\') {
      kept += ' ';
    } else {
      kept += c;
    }
  }
  return kept;
}

std::vector<OptionEntry> options_of(const CLI::App& app) {
  std::vector<OptionEntry> options;
  for (const OptionList& list : option_lists(app)) {
    for (const OptionEntry& entry : list.entries) {
      if (!entry.long_name.empty()) options.push_back(entry);
    }
  }
  return options;
}

std::string names_text(const CLI::App& app) {
  std::string names;
  for (const OptionEntry& option : options_of(app)) names += (names.empty() ? "" : " ") + option.long_name;
  return names;
}

std::string bash_script(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : verbs_of(app)) {
    verbs += verb->get_name() + " ";
    cases += fmt::format("    {}) words=\"{}\" ;;\n", verb->get_name(), names_text(*verb));
  }
  return fmt::format(R"(# bash completion for isoweave
_isoweave() {{
  local words cur="${{COMP_WORDS[COMP_CWORD]}}"
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{}help --help --version" -- "$cur"))
    return
  fi
  case "${{COMP_WORDS[1]}}" in
{}    help) words="{}" ;;
    *) words="" ;;
  esac
  if [[ "$cur" == -* || "${{COMP_WORDS[1]}}" == help ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
  fi
}}
complete -o default -F _isoweave isoweave
)",
                     verbs, cases, verbs);
}

std::string zsh_script(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : verbs_of(app)) {
    verbs += fmt::format("    '{}:{}'\n", verb->get_name(), plain(verb->get_description()));
    std::string lines;
    for (const OptionEntry& option : options_of(*verb)) {
      const std::string value = option.value.empty() ? "" : ":" + plain(option.value) + ":_files";
      lines += fmt::format("        '{}[{}]{}' \\\n", option.long_name, plain(option.text), value);
    }
    cases += fmt::format("    {})\n      _arguments \\\n{}        '*:file:_files' ;;\n", verb->get_name(), lines);
  }
  return fmt::format(R"(#compdef isoweave
local -a verbs
if (( CURRENT == 2 )); then
  verbs=(
{}    'help:Help for a verb'
  )
  _describe 'verb' verbs
else
  local verb=$words[2]
  shift words
  (( CURRENT-- ))
  case $verb in
{}    *) _files ;;
  esac
fi
)",
                     verbs, cases);
}

std::string fish_script(const CLI::App& app) {
  std::string text = "# fish completion for isoweave\n";
  for (const CLI::App* verb : verbs_of(app)) {
    text += fmt::format("complete -c isoweave -n __fish_use_subcommand -a {} -d '{}'\n", verb->get_name(),
                        plain(verb->get_description()));
    for (const OptionEntry& option : options_of(*verb)) {
      text +=
          fmt::format("complete -c isoweave -n '__fish_seen_subcommand_from {}' -l {}{} -d '{}'\n", verb->get_name(),
                      option.long_name.substr(2), option.value.empty() ? "" : " -r", plain(option.text));
    }
  }
  return text;
}

}  // namespace

std::string man_page(const CLI::App& app) {
  const bool is_verb = verbs_of(app).empty();
  const std::string name = is_verb ? "isoweave-" + app.get_name() : "isoweave";
  std::string text = fmt::format(".TH {} 1 \"\" \"isoweave {}\" \"User Commands\"\n", name, ISOWEAVE_VERSION);
  text += fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n", roff(name), roff(app.get_description()));
  text += is_verb ? fmt::format("\\fBisoweave {}\\fR {}\n", app.get_name(), roff(usage_text(app.get_name())))
                  : "\\fBisoweave\\fR \\fIVERB\\fR [options]\n";
  if (!is_verb) text += ".SH VERBS\n";
  for (const CLI::App* verb : verbs_of(app)) {
    text +=
        fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", roff("isoweave-" + verb->get_name()), roff(verb->get_description()));
  }
  for (const OptionList& list : option_lists(app)) {
    text += fmt::format(".SH \"{}\"\n", roff(list.title));
    for (const OptionEntry& entry : list.entries) text += roff_entry(entry);
  }
  text += ".SH NOTES\n.nf\n";
  const std::string footer = app.get_footer();
  for (const std::string_view line : split(footer, '\n')) {
    if (!line.empty()) text += roff(line) + "\n";
  }
  return text + ".fi\n";
}

std::string completion_script(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash_script(app);
  if (shell == "zsh") return zsh_script(app);
  if (shell == "fish") return fish_script(app);
  wrong_value("--completion", "bash, zsh or fish", shell);
}

}  // namespace isoweave::cli
