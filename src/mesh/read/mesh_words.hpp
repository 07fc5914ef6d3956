// Mesh files of text, word by word: the common part of the readers of STL, OBJ and OFF.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "files/header_text.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_place.hpp"

namespace isoweave::mesh_io {

bool is_tiny_number(std::string_view word);

// The text after `expected` in messages about a word that is no number.
const char* expected_number(std::string_view found);

// The whole of a word as a number, in the spellings of all programs: with a D before its exponent, as Fortran writes
// doubles, or as 1.#INF and 1.#QNAN, as Windows once wrote numbers that are not finite.
template <class Real>
std::optional<Real> parse_number(std::string_view word) {
  if (const std::optional<Real> value = parse_real<Real>(word)) return value;
  if (is_tiny_number(word)) return Real{0};
  if (word.find(".#") != std::string_view::npos) return std::numeric_limits<Real>::quiet_NaN();
  return parse_real<Real>(with_exponent_e(word));
}

// The number that parse_wide reads, where it is finite in 32 bits.
std::optional<double> parse_wide_number(std::string_view word);

// A byte order mark at the beginning of the file is passed over. Lines end as MeshInput::read_line says; a '#' that
// begins a word begins a comment.
class MeshWords {
 public:
  // continued: a line that ends in a backslash goes on in the next one.
  explicit MeshWords(MeshInput& input, bool continued = false);

  // Moves to the next line with a word on it; false at the end of the file.
  bool next_line();

  // The next word of the line; empty where there is none.
  std::string_view next_on_line() { return take_word(rest_); }

  // The next word of the file, on a later line where this one has no more; empty at the end of the file.
  std::string_view next();

  // The next word of the file as a number that is finite in 32 bits.
  double next_coordinate() { return coordinate(next()); }
  WidePoint next_point() { return {next_coordinate(), next_coordinate(), next_coordinate()}; }

  // A word as a number that is finite in 32 bits.
  double coordinate(std::string_view word) const;

  // The place of the mesh according to the comments read so far.
  const MeshPlace& place() const { return place_; }

  // A word as a component of a normal, which need not be finite.
  float component(std::string_view word) const;
  Point next_normal() { return {component(next()), component(next()), component(next())}; }

  // The unread part of the line.
  std::string_view rest() const { return rest_; }
  void go_on_at(std::string_view rest) { rest_ = rest; }
  void skip_line() { rest_ = {}; }

  // "PATH: line N: WHAT".
  [[noreturn]] void fail(const std::string& what) const;

  // "PATH: line N: expected EXPECTED, found 'WORD'", or the end of the file where there is no word.
  [[noreturn]] void fail(const std::string& expected, std::string_view word) const;

 private:
  bool read_line();
  std::string_view without_comment(std::string_view line);
  void join_continued();

  MeshInput& input_;
  const bool continued_;
  std::string line_, more_;
  std::string_view rest_;
  MeshPlace place_;
  std::uint64_t number_ = 0;
};

// The word with its capitals A to Z as small letters.
std::string lower_case(std::string_view word);

}  // namespace isoweave::mesh_io
