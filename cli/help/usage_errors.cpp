#include "help/usage_errors.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "help/help_text.hpp"

namespace isoweave::cli {
namespace {

// The number of characters to insert, remove, replace or swap with the next one (Damerau, "A technique for computer
// detection and correction of spelling errors", 1964).
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> edits(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        edits[i][j] = i + j;
        continue;
      }
      edits[i][j] =
          std::min({edits[i - 1][j] + 1, edits[i][j - 1] + 1, edits[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
    }
  }
  return edits[a.size()][b.size()];
}

std::vector<std::string> names_of(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

bool is_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

// A flag that takes its value behind "=" only, in front of an argument that nothing takes.
std::string flag_before(const std::vector<std::string>& arguments, const std::string& extra) {
  for (std::size_t n = 1; n < arguments.size(); ++n) {
    const std::string& before = arguments[n - 1];
    const bool takes_value = before == "--smooth" || before == "--watch" || before == "--preview";
    if (arguments[n] == extra && takes_value) return before;
  }
  return "";
}

// "-q" and the like, but no negative number.
bool is_short_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && (word[1] < '0' || word[1] > '9') && word[1] != '.';
}

}  // namespace

std::string nearest(const std::string& name, const std::vector<std::string>& known) {
  std::size_t least = std::max<std::size_t>(name.size() / 3, 1) + 1;
  std::string found;
  for (const std::string& candidate : known) {
    const std::size_t edits = edits_between(name, candidate);
    if (edits < least) {
      least = edits;
      found = candidate;
    }
  }
  return found;
}

std::string unknown_option(const CLI::App& verb, const std::vector<std::string>& arguments) {
  const std::vector<std::string> names = names_of(verb);
  for (std::size_t n = 1; n < arguments.size() && arguments[n] != "--"; ++n) {
    if (!arguments[n].starts_with("--")) continue;
    const std::string name = arguments[n].substr(0, arguments[n].find('='));
    if (std::ranges::find(names, name) != names.end()) continue;
    const std::string meant = nearest(name, names);
    return fmt::format("unknown option {}{}", name, meant.empty() ? "" : ", did you mean " + meant + "?");
  }
  return "";
}

std::string extra_text(const CLI::App& verb, const std::vector<std::string>& arguments) {
  const std::vector<std::string> extra = verb.remaining();
  if (extra.empty()) return "";
  const std::string flag = flag_before(arguments, extra.front());
  if (!flag.empty())
    return fmt::format("'{}' is one argument too many: write {}={}", extra.front(), flag, extra.front());
  if (extra.size() > 1 && std::ranges::all_of(extra, is_file)) {
    return fmt::format("found {} files more than one: put a pattern in quotes, such as 'slices/*.tif'", extra.size());
  }
  if (is_short_option(extra.front())) return "unknown option " + extra.front();
  return fmt::format("'{}' is one argument too many", extra.front());
}

std::string mismatch_text(const std::string& message) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kLists{
      {{"--iso", "300,1200"}, {"--labels", "1,3-5"}, {"--lods", "0.5vox,2vox"}}};
  const std::string option = message.substr(0, message.find(": "));
  if (message.ends_with("missing")) return option + ": expected a value, found none";
  if (message.find(": At Most 1 required") == std::string::npos) return message;
  for (const auto& [name, example] : kLists) {
    if (option == name) return fmt::format("{0}: expected once, as in {0} {1}, found more often", name, example);
  }
  return option + ": expected once, found more often";
}

std::string missing_text(const std::string& message) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kHints{
      {{"--iso is required", "a number, or auto; isoweave info VOLUME suggests some"},
       {"VOLUME is required", "a file, a folder of slices, or a pattern in quotes"},
       {"MESH is required", "a file such as bone.ply"},
       {"--error is required", "a length such as 0.1mm, or --triangles, --ratio, --lods or --max-distance"},
       {"--output is required", "a file to write, by the ending of its name"},
       {"--size is required", "a number of samples, such as 64 or 64x48x32"}}};
  for (const auto& [begin, hint] : kHints) {
    if (message.starts_with(begin)) return fmt::format("{}: {}", message, hint);
  }
  return message;
}

}  // namespace isoweave::cli
