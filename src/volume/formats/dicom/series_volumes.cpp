#include "volume/formats/dicom/series_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "files/header_text.hpp"
#include "volume/formats/chunked/array_axes.hpp"

namespace isoweave {
namespace {

// The volume that each slice belongs to, and what tells them apart.
struct Volumes {
  std::vector<std::size_t> of_slice;
  std::string by;  // for a note
};

// A thing by which images may differ: its name, and its value for an image.
struct Difference {
  std::string name;
  std::function<std::string(const DicomSlice&)> text;
};

std::vector<Difference> differences() {
  std::vector<Difference> all;
  for (std::size_t n = 0; n < kDicomMoments.size(); ++n) {
    all.push_back({std::string(kDicomMoments[n].name), [n](const DicomSlice& slice) { return slice.moments[n]; }});
  }
  all.push_back({"Image Type", [](const DicomSlice& slice) { return slice.image_type; }});
  return all;
}

// Numbers in their order, then other texts in theirs.
bool goes_before(const std::string& a, const std::string& b) {
  const auto x = parse_double(a), y = parse_double(b);
  if (x && y && *x != *y) return *x < *y;
  return x.has_value() != y.has_value() ? x.has_value() : a < b;
}

struct InOrder {
  bool operator()(const std::vector<std::string>& a, const std::vector<std::string>& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), goes_before);
  }
};

// The places of a series and the images in each: as many in one as in the other.
class SharedPlaces {
 public:
  explicit SharedPlaces(const PlacedSeries& series) : series_(series), depths_(depths_of(series)) {}

  std::size_t places() const { return depths_.distinct.size(); }
  std::size_t volumes() const { return series_.slices.size() / places(); }

  // Whether several places have several images each, all of them the same number.
  bool are_even() const {
    if (volumes() < 2 || places() < 2 || volumes() * places() != series_.slices.size()) return false;
    for (std::size_t n = 0; n < series_.slices.size(); ++n) {
      const std::size_t first = n / volumes() * volumes();
      if (place(n) != n / volumes() || !is_close(series_.slices[n].position, series_.slices[first].position))
        return false;
    }
    return true;
  }

  // The volumes by what differs between images, if all their values are different ones in every place, and the same
  // ones in all places.
  std::optional<Volumes> told_by(const std::vector<const Difference*>& by) const {
    std::map<std::vector<std::string>, std::size_t, InOrder> values;
    std::vector<std::vector<std::string>> of_slice;
    for (const PlacedSlice& slice : series_.slices) {
      std::vector<std::string> value;
      value.reserve(by.size());
      for (const Difference* one : by) value.push_back(one->text(slice.slice));
      values.emplace(value, 0);
      if (values.size() > volumes()) return std::nullopt;
      of_slice.push_back(std::move(value));
    }
    if (values.size() != volumes()) return std::nullopt;
    std::size_t number = 0;
    for (auto& [value, volume] : values) volume = number++;
    Volumes result;
    for (const std::vector<std::string>& value : of_slice) result.of_slice.push_back(values.find(value)->second);
    if (!is_one_of_each(result.of_slice)) return std::nullopt;
    result.by = text_of(by, values);
    return result;
  }

  // The volumes by Instance Number, and the frame in the file: one volume behind the other, or one place behind the
  // other.
  std::optional<Volumes> told_by_order() const {
    using Key = std::pair<std::int64_t, std::size_t>;
    std::vector<std::pair<Key, std::size_t>> order;
    for (std::size_t n = 0; n < series_.slices.size(); ++n) {
      const DicomSlice& slice = series_.slices[n].slice;
      order.push_back({{parse_integer(slice.instance).value_or(0), slice.frame}, n});
    }
    std::sort(order.begin(), order.end());
    for (std::size_t n = 1; n < order.size(); ++n) {
      if (order[n].first == order[n - 1].first) return std::nullopt;
    }
    for (const bool by_volume : {true, false}) {
      Volumes result{std::vector<std::size_t>(order.size()), "the order of their numbers (Instance Number, frame)"};
      for (std::size_t n = 0; n < order.size(); ++n) {
        result.of_slice[order[n].second] = by_volume ? n / places() : n % volumes();
      }
      if (is_one_of_each(result.of_slice) && go_one_way(order, by_volume)) return result;
    }
    return std::nullopt;
  }

 private:
  std::size_t place(std::size_t n) const { return depths_.of_slice[n]; }

  bool is_close(const Vector3& a, const Vector3& b) const {
    constexpr double kSame = 1e-2;  // of the distance of samples
    const double slack = kSame * std::min(series_.plane.row_step, series_.plane.column_step);
    for (std::size_t n = 0; n < 3; ++n) {
      if (std::abs(a[n] - b[n]) > slack) return false;
    }
    return true;
  }

  // Whether every place has an image of every volume.
  bool is_one_of_each(const std::vector<std::size_t>& volume_of) const {
    std::vector<bool> seen(volume_of.size());
    for (std::size_t n = 0; n < volume_of.size(); ++n) {
      if (volume_of[n] >= volumes()) return false;
      const std::size_t slot = place(n) * volumes() + volume_of[n];
      if (seen[slot]) return false;
      seen[slot] = true;
    }
    return true;
  }

  // Whether the places ascend or descend in the order of numbers: in every volume, or from each to the next.
  template <class Order>
  bool go_one_way(const Order& order, bool by_volume) const {
    const auto expected = [&](std::size_t n, bool up) {
      const std::size_t step = by_volume ? n % places() : n / volumes();
      return up ? step : places() - 1 - step;
    };
    const auto goes = [&](bool up) {
      for (std::size_t n = 0; n < order.size(); ++n) {
        if (place(order[n].second) != expected(n, up)) return false;
      }
      return true;
    };
    return goes(true) || goes(false);
  }

  template <class Values>
  static std::string text_of(const std::vector<const Difference*>& by, const Values& values) {
    constexpr std::size_t kListed = 8;
    std::string names, list;
    for (const Difference* one : by) names += (names.empty() ? "" : " and ") + one->name;
    std::size_t listed = 0;
    for (const auto& [value, volume] : values) {
      std::string text;
      for (const std::string& part : value) text += (text.empty() ? "" : "/") + (part.empty() ? "none" : part);
      list += (list.empty() ? "" : ", ") + (listed++ < kListed ? text : "...");
      if (listed > kListed) break;
    }
    return names + " (" + list + ")";
  }

  const PlacedSeries& series_;
  Depths depths_;
};

std::optional<Volumes> volumes_of(const PlacedSeries& series) {
  const SharedPlaces shared(series);
  if (!shared.are_even()) return std::nullopt;
  const std::vector<Difference> all = differences();
  for (const Difference& one : all) {
    if (auto volumes = shared.told_by({&one})) return volumes;
  }
  for (const Difference& one : all) {
    for (const Difference& other : all) {
      if (&one == &other) break;
      if (auto volumes = shared.told_by({&other, &one})) return volumes;
    }
  }
  return shared.told_by_order();
}

}  // namespace

void choose_volume(PlacedSeries& series, const std::string& path, const OpenOptions& options, std::string& part) {
  refuse_slices_from(options, path);
  const std::optional<Volumes> volumes = volumes_of(series);
  const std::size_t count = volumes ? 1 + *std::max_element(volumes->of_slice.begin(), volumes->of_slice.end()) : 1;
  const auto slices = static_cast<std::int64_t>(series.slices.size() / count);
  const AxisChoice choice = choose_axes({{static_cast<std::int64_t>(count), "time"},
                                         {slices, "z"},
                                         {series.facts.rows, "y"},
                                         {series.facts.columns, "x"}},
                                        options, path);
  if (!volumes) return;
  series.notes.push_back(std::to_string(count) + " volumes in the same places, told apart by " + volumes->by);
  series.notes.insert(series.notes.end(), choice.notes.begin(), choice.notes.end());
  part = choice.part;
  std::vector<PlacedSlice> chosen;
  for (std::size_t n = 0; n < series.slices.size(); ++n) {
    if (volumes->of_slice[n] == static_cast<std::size_t>(choice.at[0])) chosen.push_back(std::move(series.slices[n]));
  }
  series.slices = std::move(chosen);
}

}  // namespace isoweave
