// Labels: the numbers of a label map, and their names.
#pragma once

#include <array>
#include <compare>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#pragma GCC visibility push(default)
namespace isoweave {

// The number of a label: any whole number that 64 bits hold, with a sign or without.
class Label {
 public:
  constexpr Label() = default;

  template <std::integral Number>
  constexpr Label(Number number)  // NOLINT(google-explicit-constructor): a number is a label
      : bits_(static_cast<std::uint64_t>(number)), negative_(is_below_zero(number)) {}

  constexpr bool is_negative() const { return negative_; }

  // The number itself or, where it is negative, 2^64 more.
  constexpr std::uint64_t bits() const { return bits_; }

  // The number in decimal digits.
  std::string text() const { return negative_ ? std::to_string(signed_number()) : std::to_string(bits_); }

  friend constexpr bool operator==(const Label&, const Label&) = default;

  friend constexpr std::strong_ordering operator<=>(const Label& a, const Label& b) {
    if (a.negative_ != b.negative_) return a.negative_ ? std::strong_ordering::less : std::strong_ordering::greater;
    return a.bits_ <=> b.bits_;
  }

 private:
  template <class Number>
  static constexpr bool is_below_zero(Number number) {
    if constexpr (std::is_signed_v<Number>) return number < 0;
    return false;
  }

  std::int64_t signed_number() const { return static_cast<std::int64_t>(bits_); }

  std::uint64_t bits_ = 0;
  bool negative_ = false;
};

// The facts that a file gives about a label.
struct LabelName {
  Label label;
  std::string name;                            // as in the file, UTF-8 or what it is
  std::optional<std::array<double, 3>> color;  // red, green, blue from 0 to 1
  std::int64_t layer = 0;                      // the map that holds it, of several that overlap: OpenOptions::channel
};

}  // namespace isoweave
#pragma GCC visibility pop
