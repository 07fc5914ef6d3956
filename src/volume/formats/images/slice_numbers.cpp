#include "volume/formats/images/slice_numbers.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kDigits = "0123456789";

// A name cut at its runs of digits: "z07_a.tif" is "z#_a" with the number 7.
struct NumberedName {
  std::string file;  // without its folder, for messages
  std::string form;
  std::vector<std::int64_t> numbers;
};

using Names = std::vector<NumberedName>;

// A run of digits as a number; -1 where it is too long for one that counts.
std::int64_t number_of(std::string_view digits) {
  constexpr std::int64_t kLargest = 1'000'000'000'000'000;
  const std::int64_t number = parse_integer(digits).value_or(-1);
  return number <= kLargest ? number : -1;
}

// A path without the ending of its name, unless that is a number as in "slice.001".
std::string without_ending(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  const bool is_number = ending.find_first_not_of(kDigits, 1) == std::string::npos;
  return is_number ? path.string() : (path.parent_path() / path.stem()).string();
}

NumberedName numbered_name(const std::string& path) {
  NumberedName name{std::filesystem::path(path).filename().string(), "", {}};
  const std::string text = without_ending(path);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t digits = std::min(text.find_first_of(kDigits, at), text.size());
    const std::size_t end = std::min(text.find_first_not_of(kDigits, digits), text.size());
    name.form.append(text, at, digits - at);
    if (digits < end) {
      name.form += '#';
      name.numbers.push_back(number_of(std::string_view(text).substr(digits, end - digits)));
    }
    at = end;
  }
  return name;
}

// The step of most numbers that follow one another, and how many follow at it; of equally frequent ones the smallest.
std::pair<std::int64_t, std::size_t> usual_step(const std::set<std::int64_t>& numbers) {
  std::map<std::int64_t, std::size_t> counts;
  for (auto number = numbers.begin(); std::next(number) != numbers.end(); ++number) {
    ++counts[*std::next(number) - *number];
  }
  return *std::max_element(counts.begin(), counts.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
}

// The run of digits that counts the files: of those with the most different numbers the one that is most often followed
// by the next at one step. Nothing where no more than half are, and half are enough for a step of 1.
std::optional<std::size_t> counting_run(const Names& names) {
  std::optional<std::size_t> best;
  std::pair<std::size_t, std::size_t> best_rank;
  bool is_counter = false;
  for (std::size_t run = 0; run < names.front().numbers.size(); ++run) {
    std::set<std::int64_t> numbers;
    for (const NumberedName& name : names) numbers.insert(name.numbers[run]);
    constexpr std::size_t kFewest = 3;
    if (numbers.size() < kFewest || *numbers.begin() < 0) continue;
    const auto [step, follow] = usual_step(numbers);
    const std::pair rank(numbers.size(), follow);
    if (best && rank <= best_rank) continue;
    best_rank = rank;
    best = run;
    is_counter = 2 * follow >= numbers.size() - (step == 1 ? 1 : 0);
  }
  return is_counter ? best : std::nullopt;
}

struct Missing {
  std::int64_t slices = 0;
  std::size_t gaps = 0;
  std::string where;
};

// Counts what is missing between neighbours.
void add_missing(Missing& missing, const NumberedName& a, const NumberedName& b, std::int64_t numbers,
                 std::int64_t step) {
  constexpr std::size_t kNamed = 3;
  if (numbers <= step) return;
  missing.slices += std::max<std::int64_t>((numbers + step / 2) / step - 1, 1);
  if (++missing.gaps > kNamed) return;
  missing.where += (missing.gaps == 1 ? "between " : ", between ") + in_quotes(a.file) + " and " + in_quotes(b.file);
}

std::string missing_text(const Missing& missing, std::int64_t step) {
  constexpr std::size_t kNamed = 3;
  std::string text = missing.slices == 1 ? "1 slice seems" : std::to_string(missing.slices) + " slices seem";
  text += " to be missing by the numbers of the files: " + missing.where;
  if (missing.gaps > kNamed) text += ", and " + std::to_string(missing.gaps - kNamed) + " more gaps";
  return text + (step > 1 ? "; the numbers are usually " + std::to_string(step) + " apart" : "");
}

void note_numbers(Names names, std::size_t run, std::vector<std::string>& notes) {
  std::set<std::int64_t> numbers;
  for (const NumberedName& name : names) numbers.insert(name.numbers[run]);
  const std::int64_t step = usual_step(numbers).first;
  std::stable_sort(names.begin(), names.end(),
                   [run](const NumberedName& a, const NumberedName& b) { return a.numbers[run] < b.numbers[run]; });
  Missing missing;
  std::size_t twice = 0;
  std::string which;
  for (std::size_t n = 1; n < names.size(); ++n) {
    add_missing(missing, names[n - 1], names[n], names[n].numbers[run] - names[n - 1].numbers[run], step);
    if (names[n].numbers != names[n - 1].numbers) continue;
    if (++twice == 1) which = in_quotes(names[n - 1].file) + " and " + in_quotes(names[n].file);
  }
  if (missing.slices > 0) notes.push_back(missing_text(missing, step));
  if (twice == 1) notes.push_back(which + " have the same number, and both are taken as slices");
  if (twice > 1) {
    notes.push_back(std::to_string(twice) + " files have the number of another, as " + which +
                    " have, and all are taken as slices");
  }
}

}  // namespace

std::vector<std::string> notes_on_numbers(const std::vector<std::string>& files) {
  std::map<std::string, Names> by_form;
  for (const std::string& file : files) {
    NumberedName name = numbered_name(file);
    by_form[name.form].push_back(std::move(name));
  }
  std::vector<std::string> notes;
  for (const auto& [form, names] : by_form) {
    if (const std::optional<std::size_t> run = counting_run(names)) note_numbers(names, *run, notes);
  }
  return notes;
}

}  // namespace isoweave
