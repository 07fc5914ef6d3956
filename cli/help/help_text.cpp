#include "help/help_text.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "help/option_table.hpp"
#include "options/values.hpp"

namespace isoweave::cli {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kColumn = 25;  // where descriptions begin

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

OptionEntry entry_of(const CLI::Option& option) {
  OptionEntry entry;
  if (option.get_positional()) {
    entry.value = option.get_name(true);
  } else {
    if (!option.get_snames().empty()) entry.short_name = "-" + option.get_snames().front();
    if (!option.get_lnames().empty()) entry.long_name = "--" + option.get_lnames().front();
    if (takes_value(option)) entry.value = option.get_type_name();
  }
  entry.text = option.get_description();
  const std::string usual = option.get_default_str();
  if (!usual.empty() && takes_value(option)) entry.text += fmt::format(" [{}]", usual);
  return entry;
}

std::string line_of(const OptionEntry& entry) {
  std::string names = entry.short_name;
  if (!entry.long_name.empty()) names += (names.empty() ? "" : ", ") + entry.long_name;
  const std::string left = fmt::format("  {}{}{}", names, names.empty() || entry.value.empty() ? "" : " ", entry.value);
  const std::string text = wrapped(entry.text, kColumn, kWidth);
  if (left.size() + 2 > kColumn) return fmt::format("{}\n{:{}}{}\n", left, "", kColumn, text);
  return fmt::format("{:<{}}{}\n", left, kColumn, text);
}

class HelpText final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    const std::vector<const CLI::App*> verbs = verbs_of(*app);
    std::string text = app->get_description() + "\n\n";
    text += fmt::format("Usage: {} {}\n", name, verbs.empty() ? usage_text(app->get_name()) : "VERB [options]");
    if (!verbs.empty()) {
      text += "\nVerbs:\n";
      for (const CLI::App* verb : verbs) text += line_of({"", "", verb->get_name(), verb->get_description()});
    }
    for (const OptionList& list : option_lists(*app)) {
      text += fmt::format("\n{}:\n", list.title);
      for (const OptionEntry& entry : list.entries) text += line_of(entry);
    }
    return text + app->get_footer() + "\n";
  }
};

}  // namespace

std::vector<OptionList> option_lists(const CLI::App& app) {
  OptionList arguments{"Arguments", {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) arguments.entries.push_back(entry_of(*option));
  }
  std::vector<OptionList> lists{std::move(arguments)};
  for (const std::string& group : option_groups()) {
    OptionList& list = lists.emplace_back(OptionList{group, {}});
    for (const CLI::Option* option : app.get_options()) {
      if (!option->get_positional() && option->get_group() == group) list.entries.push_back(entry_of(*option));
    }
  }
  std::erase_if(lists, [](const OptionList& list) { return list.entries.empty(); });
  return lists;
}

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

void use_help_text(CLI::App& app) { app.formatter(std::make_shared<HelpText>()); }

std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::string lines;
  std::size_t column = indent;
  for (const std::string_view word : split(text, ' ')) {
    const bool first = column == indent;
    if (!first && column + 1 + word.size() > width) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!first) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

}  // namespace isoweave::cli
