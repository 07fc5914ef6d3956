#include "volume/formats/dicom/dicom_scouts.hpp"

#include <algorithm>
#include <cmath>

#include "files/quoted.hpp"
#include "volume/formats/dicom/dicom_numbers.hpp"

namespace isoweave {
namespace {

struct Look {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  int samples = 1;
  bool is_localizer = false;
  std::vector<double> orientation;    // empty where it is not said
  std::vector<double> pixel_spacing;  // the same
};

Look look_of(const DicomSlice& slice) {
  return {slice.columns,
          slice.rows,
          slice.samples,
          slice.image_type.find("LOCALIZER") != std::string::npos,
          leading_numbers(slice.orientation),
          leading_numbers(slice.pixel_spacing)};
}

bool are_close(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kSlack = 1e-3;
  // Directions are compared by their length, 1; lengths by the longer one.
  const double least = a.size() == 6 ? 1 : 0;
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [least](double x, double y) {
    return std::abs(x - y) <= kSlack * std::max({least, std::abs(x), std::abs(y)});
  });
}

bool is_same_size(const Look& a, const Look& b) { return a.columns == b.columns && a.rows == b.rows; }

bool is_same(const Look& a, const Look& b) {
  return is_same_size(a, b) && a.samples == b.samples && a.is_localizer == b.is_localizer &&
         are_close(a.orientation, b.orientation) && are_close(a.pixel_spacing, b.pixel_spacing);
}

// The reason why an image is no slice of the series.
std::string reason(const Look& scout, const Look& usual) {
  if (scout.is_localizer && !usual.is_localizer) return "a localizer";
  if (scout.samples != usual.samples) return "in colour";
  if (scout.orientation.empty()) return "without an orientation";
  if (!are_close(scout.orientation, usual.orientation)) return "in another orientation";
  if (!is_same_size(scout, usual)) return std::to_string(scout.columns) + " x " + std::to_string(scout.rows);
  if (!are_close(scout.pixel_spacing, usual.pixel_spacing)) return "of another pixel spacing";
  return "no localizer as the others are";
}

// The look of more than half of all, by the vote of Boyer and Moore; the first one's where there is none.
std::size_t most_common(const std::vector<Look>& looks) {
  std::size_t leader = 0;
  std::size_t votes = 0;
  for (std::size_t n = 0; n < looks.size(); ++n) {
    if (votes == 0) leader = n;
    is_same(looks[n], looks[leader]) ? ++votes : --votes;
  }
  return leader;
}

}  // namespace

std::vector<DicomSlice> without_scouts(const std::vector<DicomSlice>& series, std::vector<std::string>& notes) {
  constexpr std::size_t kNamed = 3;
  std::vector<Look> looks;
  looks.reserve(series.size());
  for (const DicomSlice& slice : series) looks.push_back(look_of(slice));
  const Look& usual = looks[most_common(looks)];
  std::vector<DicomSlice> slices;
  std::string names;
  for (std::size_t n = 0; n < series.size(); ++n) {
    if (is_same(looks[n], usual)) {
      slices.push_back(series[n]);
    } else if (n - slices.size() < kNamed) {
      names += (names.empty() ? "" : ", ") + in_quotes(series[n].name()) + " (" + reason(looks[n], usual) + ")";
    }
  }
  const std::size_t left_out = series.size() - slices.size();
  if (left_out == 0 || slices.size() <= left_out) return series;
  if (left_out > kNamed) names += ", ...";
  notes.push_back((left_out == 1 ? "1 image of the series is no slice of its volume and is left out: "
                                 : std::to_string(left_out) +
                                       " images of the series are no slices of its volume and are left out: ") +
                  names);
  return slices;
}

}  // namespace isoweave
