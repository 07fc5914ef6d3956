#include "mesh/read/mesh_words.hpp"

#include <cmath>
#include <limits>

#include "files/from_chars.hpp"

namespace isoweave::mesh_io {
namespace {

bool is_number(std::string_view word) {
  return !word.empty() && word.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
}

}  // namespace

// A number that even a double cannot hold, because it is too small.
bool is_tiny_number(std::string_view word) {
  double ignored = 0;
  const auto [end, error] = number_from_chars(word.data(), word.data() + word.size(), ignored);
  const bool whole = end == word.data() + word.size() && error == std::errc::result_out_of_range;
  return whole && (word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos);
}

std::optional<double> parse_wide_number(std::string_view word) {
  const std::optional<double> value = parse_wide(word);
  return value ? value : parse_number<double>(word);
}

const char* expected_number(std::string_view found) {
  const bool comma = found.find(',') != std::string_view::npos;
  return comma ? "expected a number with a decimal point" : "expected a number";
}

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

MeshWords::MeshWords(MeshInput& input, bool continued) : input_(input), continued_(continued) {
  skip_byte_order_mark(input);
}

bool MeshWords::next_line() {
  while (read_line()) {
    std::string_view look = rest_;
    if (!take_word(look).empty()) return true;
  }
  return false;
}

std::string_view MeshWords::next() {
  for (;;) {
    const std::string_view word = next_on_line();
    if (!word.empty() || !read_line()) return word;
  }
}

double MeshWords::coordinate(std::string_view word) const {
  const std::optional<double> value = parse_wide_number(word);
  if (value && std::abs(*value) <= double{std::numeric_limits<float>::max()}) return *value;
  if (value && std::isfinite(*value)) fail("expected a number that 32 bits hold, up to 3.4e38", word);
  fail(value || is_number(word) ? "expected a finite number" : expected_number(word), word);
}

float MeshWords::component(std::string_view word) const {
  const std::optional<float> value = parse_number<float>(word);
  return value ? *value : static_cast<float>(coordinate(word));
}

void MeshWords::fail(const std::string& what) const { input_.fail("line " + std::to_string(number_) + ": " + what); }

void MeshWords::fail(const std::string& expected, std::string_view word) const {
  if (word.empty())
    fail(expected + ", found " + (input_.remaining() == 0 ? "the end of the file" : "the end of the line"));
  fail(expected + ", found '" + std::string(word.substr(0, 40)) + "'");
}

// The part of a line before its comment, which begins a word. The infinity of Windows, 1.#INF, begins no comment.
std::string_view MeshWords::without_comment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    if (at > 0 && !is_blank(line[at - 1])) continue;
    place_.take_comment(line.substr(at + 1));
    return line.substr(0, at);
  }
  return line;
}

// Reads a line, without its end and its comment.
bool MeshWords::read_line() {
  if (!input_.read_line(line_)) {
    rest_ = {};
    return false;
  }
  ++number_;
  line_.resize(without_comment(line_).size());
  if (line_.ends_with(kEndOfText)) line_.pop_back();
  if (continued_) join_continued();
  rest_ = line_;
  return true;
}

// Joins lines that end in a backslash, which blanks may follow.
void MeshWords::join_continued() {
  for (;;) {
    while (!line_.empty() && is_blank(line_.back())) line_.pop_back();
    if (line_.empty() || line_.back() != '\\') return;
    line_.back() = ' ';
    if (!input_.read_line(more_)) fail("truncated: expected a line after '\\', found the end of the file");
    ++number_;
    if (line_.size() + more_.size() > kLongestLine) fail("a statement is longer than a megabyte");
    line_.append(without_comment(more_));
  }
}

}  // namespace isoweave::mesh_io
