// Looks at the distances between slices: which of them are missing, and what grid holds them all.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/even_slices.hpp"

namespace isoweave {
namespace {

// How far slices may lie from even places and still count as even, in parts of the distance.
constexpr double kEven = 1e-2;
// A gap from here on may hold a slice.
constexpr double kWide = 1.5;

// A length as a person would write it.
std::string length_text(double length) {
  constexpr int kDigits = 4;
  std::array<char, 32> text;
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), length, std::chars_format::general, kDigits);
  return error == std::errc{} ? std::string(text.data(), end) : std::string();
}

// The gaps between neighbours: gap n lies above slice n.
struct SliceGaps {
  std::vector<double> lengths;
  double usual = 0;  // the median
  std::size_t narrowest = 0;
  std::size_t widest = 0;

  explicit SliceGaps(const std::vector<double>& depths) {
    for (std::size_t n = 1; n < depths.size(); ++n) lengths.push_back(depths[n] - depths[n - 1]);
    std::vector<double> sorted = lengths;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    usual = *middle;
    narrowest = static_cast<std::size_t>(std::min_element(lengths.begin(), lengths.end()) - lengths.begin());
    widest = static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  }

  std::string range(const std::string& unit) const {
    return length_text(lengths[narrowest]) + " to " + length_text(lengths[widest]) + unit;
  }
};

std::string between_names(const SlicePlaces& places, std::size_t gap) {
  return "between " + in_quotes(places.name(gap)) + " and " + in_quotes(places.name(gap + 1));
}

void refuse_coinciding(const SlicePlaces& places, const SliceGaps& gaps) {
  constexpr double kSamePlace = 1e-2;
  for (std::size_t n = 0; n < gaps.lengths.size(); ++n) {
    if (gaps.lengths[n] > kSamePlace * gaps.usual && gaps.lengths[n] > 0) continue;
    bad_input(places.file(n + 1), "a position of its own for every slice", "that of " + in_quotes(places.name(n)));
  }
}

// The number of slices that a gap has lost; 0 unless the gap is nearly a multiple of the usual one.
std::int64_t lost_in(double gap, double usual) {
  constexpr double kMost = 1e6;
  constexpr double kNearly = 0.2;
  const double times = gap / usual;
  if (times < kWide || times > kMost || std::abs(times - std::round(times)) > kNearly) return 0;
  return std::llround(times) - 1;
}

// Whether a wide gap is one of three or more in a row. Then the distance has changed, and no slice is lost.
bool is_another_distance(const SliceGaps& gaps, std::size_t gap) {
  const auto is_wide = [&](std::size_t n) { return n < gaps.lengths.size() && gaps.lengths[n] > kWide * gaps.usual; };
  const std::size_t below = gap == 0 || !is_wide(gap - 1) ? 0 : gap == 1 || !is_wide(gap - 2) ? 1 : 2;
  const std::size_t above = !is_wide(gap + 1) ? 0 : !is_wide(gap + 2) ? 1 : 2;
  return below + above >= 2;
}

void note_missing(const SlicePlaces& places, const SliceGaps& gaps, std::vector<std::string>& notes) {
  constexpr std::size_t kNamed = 3;
  std::int64_t missing = 0;
  std::size_t wide = 0;
  std::string where;
  for (std::size_t n = 0; n < gaps.lengths.size(); ++n) {
    const std::int64_t lost = lost_in(gaps.lengths[n], gaps.usual);
    if (lost == 0 || is_another_distance(gaps, n)) continue;
    missing += lost;
    if (++wide > kNamed) continue;
    where += (wide == 1 ? "" : ", ") + length_text(gaps.lengths[n]) + places.unit + " " + between_names(places, n);
  }
  if (missing == 0) return;
  if (wide > kNamed) where += ", and " + std::to_string(wide - kNamed) + " more gaps";
  notes.push_back((missing == 1 ? "1 slice seems" : std::to_string(missing) + " slices seem") + " to be missing: " +
                  where + "; slices are usually " + length_text(gaps.usual) + places.unit + " apart");
}

// The farthest that a slice lies from its place at an even distance between the first and the last slice.
double farthest_from_even(const std::vector<double>& depths) {
  const double mean = (depths.back() - depths.front()) / static_cast<double>(depths.size() - 1);
  double farthest = 0;
  for (std::size_t n = 0; n < depths.size(); ++n) {
    farthest = std::max(farthest, std::abs(depths[n] - depths.front() - mean * static_cast<double>(n)));
  }
  return farthest;
}

// The finest distance that is no exception: the mean of the narrowest gaps, if these are near the usual gap or many.
double finest_distance(const SliceGaps& gaps) {
  constexpr double kFar = 1.0 / 8;
  constexpr double kAlike = 1.1;
  constexpr std::size_t kMany = 10;  // one in so many
  std::vector<double> sorted = gaps.lengths;
  std::sort(sorted.begin(), sorted.end());
  auto first = sorted.begin();
  while (true) {
    const auto end = std::upper_bound(first, sorted.end(), *first * kAlike);
    const auto alike = static_cast<std::size_t>(end - first);
    if (*first >= kFar * gaps.usual || alike * kMany >= sorted.size()) {
      double sum = 0;
      for (auto gap = first; gap != end; ++gap) sum += *gap;
      return sum / static_cast<double>(alike);
    }
    first = end;
  }
}

// How far a slice may lie beside its place: a hundredth of the distance, or the rounding of positions where that is
// little.
double slack_at(const SlicePlaces& places, double distance) {
  constexpr double kLittle = 0.05;
  const double rounding = places.rounding <= kLittle * distance ? places.rounding : 0;
  return std::max(kEven * distance, rounding);
}

// Slices at the finest distance, or a little closer so that the last one stays where it is.
EvenGrid finest_grid(const SlicePlaces& places, const SliceGaps& gaps) {
  constexpr double kWidest = 32;
  constexpr double kRounding = 0.05;  // of a slice
  EvenGrid grid{places.depths, 0, 0, true};
  const double finest = finest_distance(gaps);
  // Slices so far apart belong to several volumes, and nothing can be said about the space between them.
  if (!(gaps.lengths[gaps.widest] <= kWidest * finest)) {
    bad_input(places.path, "slices that lie together, with no gap of more than 32 of them",
              length_text(gaps.lengths[gaps.widest]) + places.unit + " " + between_names(places, gaps.widest) +
                  ", where " + length_text(finest) + places.unit + " are usual");
  }
  const double steps = (places.depths.back() - places.depths.front()) / finest;
  grid.count = std::max<std::int64_t>(std::llround(std::ceil(steps - kRounding)), 1) + 1;
  grid.slack = slack_at(places, grid.distance());
  return grid;
}

std::string resampled_text(const EvenGrid& grid, const std::string& unit) {
  std::int64_t made = 0;
  std::int64_t first = 0;
  std::int64_t last = 0;
  for (std::int64_t n = 0; n < grid.count; ++n) {
    if (grid.place(n).weight == 0) continue;
    if (made++ == 0) first = n;
    last = n;
  }
  std::string text = "they are read as " + std::to_string(grid.count) + " slices " + length_text(grid.distance()) +
                     unit + " apart, " + std::to_string(made) + " of which " + (made == 1 ? "is" : "are") +
                     " interpolated";
  if (made == 1) text += " (number " + std::to_string(first) + ", from 0)";
  if (made > 1) text += " (numbers " + std::to_string(first) + " to " + std::to_string(last) + ", from 0)";
  return text;
}

}  // namespace

EvenGrid even_grid(const SlicePlaces& places, UnevenSlices uneven, std::vector<std::string>& notes) {
  constexpr double kExact = 1e-3;
  EvenGrid as_they_are{places.depths, static_cast<std::int64_t>(places.depths.size()), 0, false};
  if (places.depths.size() < 2) return as_they_are;
  const SliceGaps gaps(places.depths);
  refuse_coinciding(places, gaps);
  const double farthest = farthest_from_even(places.depths);
  const double mean = as_they_are.distance();
  if (farthest <= kExact * mean) return as_they_are;
  if (farthest <= slack_at(places, mean)) {
    const bool is_rounded = farthest > kEven * mean;
    notes.push_back("the slices lie up to " + length_text(farthest) + places.unit + " beside an even distance of " +
                    length_text(mean) + places.unit + ": less than " +
                    (is_rounded ? "their positions are rounded by" : "a hundredth of it") + ", and taken as even");
    return as_they_are;
  }
  if (uneven == UnevenSlices::kRefuse) {
    bad_input(places.path, "slices at an even distance (--even-spacing resample or mean reads others)",
              "distances of " + gaps.range(places.unit) + ", the widest " + between_names(places, gaps.widest));
  }
  note_missing(places, gaps, notes);
  const std::string apart = "the slices are " + gaps.range(places.unit) + " apart: ";
  if (uneven == UnevenSlices::kMean) {
    notes.push_back(apart + "the mean of " + length_text(mean) + places.unit + " is used, which puts slices up to " +
                    length_text(farthest) + places.unit + " from where they are");
    return as_they_are;
  }
  EvenGrid grid = finest_grid(places, gaps);
  notes.push_back(apart + resampled_text(grid, places.unit));
  return grid;
}

}  // namespace isoweave
