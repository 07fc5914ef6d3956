#include "isoweave/label_names.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <utility>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

using Color = std::array<double, 3>;

constexpr double kMostOfColor = 255;

// Three numbers from 0 to 255.
std::optional<Color> color_of(std::span<const std::string_view> words) {
  Color color{};
  for (std::size_t n = 0; n < color.size(); ++n) {
    const auto value = parse_integer(words[n]);
    if (!value || *value < 0 || *value > 255) return std::nullopt;
    color[n] = static_cast<double>(*value) / kMostOfColor;
  }
  return color;
}

// "#RRGGBB"
std::optional<Color> color_of_digits(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Color color{};
  for (std::size_t n = 0; n < color.size(); ++n) {
    unsigned value = 0;
    const char* const begin = text.data() + 1 + 2 * n;
    const auto [stop, error] = std::from_chars(begin, begin + 2, value, 16);
    if (error != std::errc{} || stop != begin + 2) return std::nullopt;
    color[n] = value / kMostOfColor;
  }
  return color;
}

// "Index Name R G B A": a name may hold blanks, and the colour may lack its last number, or be missing.
std::optional<LabelName> parse_plain(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  const std::optional<Label> label = words.size() < 2 ? std::nullopt : parse_label(words[0]);
  if (!label) return std::nullopt;
  LabelName entry{*label, {}, {}, 0};
  std::size_t end = words.size();
  for (const std::size_t numbers : {std::size_t{4}, std::size_t{3}}) {
    if (words.size() < 2 + numbers) continue;
    const std::span<const std::string_view> last(words.end() - static_cast<std::ptrdiff_t>(numbers), words.end());
    if (numbers == 4 && !parse_double(last[3])) continue;
    entry.color = color_of(last);
    if (!entry.color) continue;
    end -= numbers;
    break;
  }
  const char* const behind = words[end - 1].data() + words[end - 1].size();
  entry.name.assign(words[1].data(), behind);
  return entry;
}

// "Index R G B A Visible Mesh "Name""
std::optional<LabelName> parse_snap(std::string_view line) {
  const std::size_t open = line.find('"');
  const std::size_t close = line.rfind('"');
  if (open == std::string_view::npos || close == open) return std::nullopt;
  const std::vector<std::string_view> words = words_of(line.substr(0, open));
  if (words.size() != 7 || !trimmed(line.substr(close + 1)).empty()) return std::nullopt;
  const std::optional<Label> label = parse_label(words[0]);
  const std::optional<Color> color = color_of(std::span(words).subspan(1));
  if (!label || !color) return std::nullopt;
  return LabelName{*label, std::string(line.substr(open + 1, close - open - 1)), color, 0};
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t tab = line.find('\t');
    cells.push_back(trimmed(line.substr(0, tab)));
    if (tab == std::string_view::npos) return cells;
    line.remove_prefix(tab + 1);
  }
}

// A table of the columns that its first line names.
class Table {
 public:
  // Nothing when the line names no columns of labels.
  static std::optional<Table> begin(std::string_view line) {
    Table table;
    const std::vector<std::string_view> cells = cells_of(line);
    for (std::size_t n = 0; n < cells.size(); ++n) table.columns_.emplace(lower_case(cells[n]), n);
    if (!table.columns_.contains("index") || !table.columns_.contains("name")) return std::nullopt;
    return table;
  }

  std::optional<LabelName> parse(std::string_view line) const {
    const std::vector<std::string_view> cells = cells_of(line);
    const auto cell = [&](const std::string& column) {
      const auto found = columns_.find(column);
      return found == columns_.end() || found->second >= cells.size() ? std::string_view() : cells[found->second];
    };
    const std::optional<Label> label = parse_label(cell("index"));
    if (!label) return std::nullopt;
    return LabelName{*label, std::string(cell("name")), color_of_digits(cell("color")), 0};
  }

 private:
  std::map<std::string, std::size_t> columns_;
};

class NameReader {
 public:
  explicit NameReader(const std::string& path) : path_(path) {}

  void take_line(std::string_view line) {
    ++line_;
    if (trimmed(line).empty() || line.starts_with('#')) return;
    if (names_.empty() && !table_ && (table_ = Table::begin(line))) return;
    std::optional<LabelName> entry = table_ ? table_->parse(line) : parse_snap(line);
    if (!entry && !table_) entry = parse_plain(line);
    if (!entry) refuse(line);
    const auto [known, is_new] = by_label_.emplace(entry->label, names_.size());
    if (is_new) {
      names_.push_back(std::move(*entry));
    } else if (names_[known->second].name != entry->name) {
      bad_input(path_, "one name of label " + entry->label.text(),
                in_quotes(names_[known->second].name) + " and " + in_quotes(entry->name));
    }
  }

  std::vector<LabelName> finish() {
    if (names_.empty()) bad_input(path_, "names of labels", "none");
    return std::move(names_);
  }

 private:
  [[noreturn]] void refuse(std::string_view line) const {
    bad_input(path_,
              table_ ? "a whole number as 'index'" : "lines 'INDEX NAME R G B A' or 'INDEX R G B A V M \"NAME\"'",
              in_quotes(line) + " in line " + std::to_string(line_));
  }

  const std::string& path_;
  std::size_t line_ = 0;
  std::optional<Table> table_;
  std::vector<LabelName> names_;
  std::map<Label, std::size_t> by_label_;
};

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of byte order
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

// Bytes of the UTF-8 character at the beginning of a text; 0 where there is none.
std::size_t length_of_character(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length > text.size()) return 0;
  for (std::size_t n = 1; n < length; ++n) {
    if ((static_cast<unsigned char>(text[n]) & 0xc0) != 0x80) return 0;
  }
  return length;
}

bool is_safe(std::string_view character) {
  constexpr std::string_view kSafe = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.+";
  if (character.size() == 1) return kSafe.find(character[0]) != std::string_view::npos;
  return character < "\xc2\x80" || character >= "\xc2\xa0";  // those between are control characters
}

// A name without characters that mean something in a path, and short enough for a file name with other parts beside it.
std::string safe_name(std::string_view name) {
  constexpr std::size_t kLongest = 100;
  std::string safe;
  for (name = trimmed(name); !name.empty();) {
    const std::size_t length = length_of_character(name);
    const std::string_view character = name.substr(0, std::max<std::size_t>(length, 1));
    if (safe.size() + character.size() > kLongest) break;
    safe += length > 0 && is_safe(character) ? std::string(character) : "_";
    name.remove_prefix(character.size());
  }
  return safe;
}

std::string number_name(const LabelName& entry) {
  const std::string layer = entry.layer > 0 ? "layer" + std::to_string(entry.layer) + "_" : "";
  return layer + "label" + entry.label.text();
}

}  // namespace

std::optional<Label> parse_label(std::string_view text) {
  const char* const end = text.data() + text.size();
  const auto as = [&]<class Number>(Number number) -> std::optional<Label> {
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc{} && stop == end ? std::optional<Label>(number) : std::nullopt;
  };
  const std::optional<Label> label = as(std::uint64_t{0});
  return label ? label : as(std::int64_t{0});
}

std::vector<LabelName> read_label_names(const std::string& path) {
  constexpr std::uint64_t kLargest = 64 << 20;
  const auto file = open_file(path);
  if (file->size() > kLargest) {
    bad_input(path, "at most " + std::to_string(kLargest) + " bytes of names", std::to_string(file->size()));
  }
  const std::string text = file->head(static_cast<std::size_t>(file->size()));
  LineReader lines(without_mark(text));
  NameReader reader(path);
  while (const auto line = lines.next()) reader.take_line(*line);
  return reader.finish();
}

std::vector<std::string> label_file_names(std::span<const LabelName> labels) {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> uses;
  std::set<std::string> taken;
  for (const LabelName& entry : labels) {
    const std::string name = safe_name(entry.name);
    names.push_back(name.empty() ? number_name(entry) : name);
    ++uses[lower_case(names.back())];
    if (name.empty()) taken.insert(names.back());
  }
  for (std::size_t n = 0; n < names.size(); ++n) {
    const std::string number = number_name(labels[n]);
    if (names[n] == number) continue;
    if (uses[lower_case(names[n])] > 1) names[n] += "_" + number;
    while (!taken.insert(lower_case(names[n])).second) names[n] += "_" + number;
  }
  return names;
}

}  // namespace isoweave
