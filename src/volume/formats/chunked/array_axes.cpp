#include "volume/formats/chunked/array_axes.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kI = 0;
constexpr std::size_t kK = 2;

enum class AxisKind { kX, kY, kZ, kChannel, kTime, kOther };

AxisKind kind_of(const ArrayAxis& axis) {
  const std::string name = lower_case(axis.name);
  if (name == "x") return AxisKind::kX;
  if (name == "y") return AxisKind::kY;
  if (name == "z") return AxisKind::kZ;
  if (name == "c" || name == "channel" || name == "channels") return AxisKind::kChannel;
  if (name == "t" || name == "time") return AxisKind::kTime;
  return AxisKind::kOther;
}

std::string text_of(const std::vector<ArrayAxis>& axes) {
  std::string text;
  for (const ArrayAxis& axis : axes) {
    text += (text.empty() ? "" : " x ") + std::to_string(axis.size);
    if (!axis.name.empty()) text += " (" + in_quotes(axis.name) + ")";
  }
  return text;
}

std::string axes_found(const std::vector<ArrayAxis>& axes) {
  return axes.empty() ? "a single value without axes" : "axes of " + text_of(axes);
}

bool are_named(const std::vector<ArrayAxis>& axes) {
  bool x = false, y = false;
  for (const ArrayAxis& axis : axes) {
    x = x || kind_of(axis) == AxisKind::kX;
    y = y || kind_of(axis) == AxisKind::kY;
  }
  return x && y;
}

// Whether the axes that are i, j and k leave no more than one slice.
bool is_flat(const std::vector<ArrayAxis>& axes) {
  return std::none_of(axes.begin(), axes.end(),
                      [](const ArrayAxis& axis) { return kind_of(axis) == AxisKind::kZ && axis.size > 1; });
}

// Takes an index along an axis of channels or of time.
void take_index(AxisChoice& choice, std::size_t n, const std::vector<ArrayAxis>& axes,
                const std::optional<std::int64_t>& asked, std::string_view word, std::string_view path) {
  const std::string what(word);
  const ArrayAxis& axis = axes[n];
  if (asked && (*asked < 0 || *asked >= axis.size)) {
    bad_input(path, "--" + what + " below " + std::to_string(axis.size), std::to_string(*asked));
  }
  choice.at[n] = asked.value_or(0);
  if (!asked && axis.size > 1) {
    choice.notes.push_back("the first of " + std::to_string(axis.size) + " along " + what + " is read; --" + what +
                           " chooses");
    if (are_named(axes) && is_flat(axes)) {
      choice.notes.back() += ", --slices-from " + what + " takes them for slices";
    }
  }
  if (axis.size > 1) choice.part += (choice.part.empty() ? "" : ", ") + what + " " + std::to_string(choice.at[n]);
}

void check_asked(bool there, const std::optional<std::int64_t>& asked, std::string_view word,
                 const std::vector<ArrayAxis>& axes, std::string_view path) {
  if (there || !asked) return;
  bad_input(path, "an axis for --" + std::string(word), axes_found(axes));
}

AxisChoice choose_named(const std::vector<ArrayAxis>& axes, const OpenOptions& options, std::string_view path) {
  AxisChoice choice;
  choice.at.assign(axes.size(), 0);
  bool channels = false, times = false;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    const AxisKind kind = kind_of(axes[n]);
    if (kind == AxisKind::kChannel) {
      if (std::exchange(channels, true)) bad_input(path, "one axis of channels", text_of(axes));
      take_index(choice, n, axes, options.channel, "channel", path);
    } else if (kind == AxisKind::kTime) {
      if (std::exchange(times, true)) bad_input(path, "one axis of time", text_of(axes));
      take_index(choice, n, axes, options.time, "time", path);
    } else if (kind == AxisKind::kOther) {
      if (axes[n].size > 1) bad_input(path, "axes x, y, z, channel and time", text_of(axes));
      if (axes[n].name.empty()) continue;
      choice.notes.push_back("axis " + in_quotes(axes[n].name) + " has one sample and is left out");
    } else {
      std::size_t& slot = choice.axis.at(static_cast<std::size_t>(kind));
      if (slot != kNoAxis) bad_input(path, "one axis of each name", text_of(axes));
      slot = n;
    }
  }
  check_asked(channels, options.channel, "channel", axes, path);
  check_asked(times, options.time, "time", axes, path);
  return choice;
}

// Swaps the names of the axis of slices and of the axis that the options take slices from. Returns the place of the
// former, which says how far slices are apart; kNoAxis where nothing changes.
std::size_t take_slices_from(std::vector<ArrayAxis>& axes, SliceAxis from, std::string_view path) {
  if (from == SliceAxis::kSlices) return kNoAxis;
  const bool channels = from == SliceAxis::kChannels;
  const std::string word = channels ? "channel" : "time";
  const auto named = [&axes](AxisKind kind) {
    return std::find_if(axes.begin(), axes.end(), [kind](const ArrayAxis& axis) { return kind_of(axis) == kind; });
  };
  const auto holder = named(channels ? AxisKind::kChannel : AxisKind::kTime);
  const auto slices = named(AxisKind::kZ);
  if (holder == axes.end()) bad_input(path, "an axis for --slices-from " + word, axes_found(axes));
  if (slices != axes.end() && slices->size > 1) {
    bad_input(path, "one slice for --slices-from " + word, std::to_string(slices->size));
  }
  if (holder->size == 1) bad_input(path, "several samples along " + word + " for --slices-from " + word, "one");
  holder->name = "z";
  if (slices == axes.end()) return kNoAxis;
  slices->name = word;
  return static_cast<std::size_t>(slices - axes.begin());
}

// Chooses axes without names: the ones that are left out, so that the others are k, j, i.
AxisChoice choose_unnamed(const std::vector<ArrayAxis>& axes, const OpenOptions& options, std::string_view path) {
  AxisChoice choice;
  choice.at.assign(axes.size(), 0);
  std::size_t first = 0;
  const auto take_leading = [&](const std::optional<std::int64_t>& asked, std::string_view word) {
    if (!asked) return;
    if (axes.size() - first <= 3) bad_input(path, "an axis for --" + std::string(word), axes_found(axes));
    take_index(choice, first, axes, asked, word, path);
    choice.notes.push_back("axis " + std::to_string(first) + " has no name and is taken for " + std::string(word));
    ++first;
  };
  take_leading(options.time, "time");
  take_leading(options.channel, "channel");
  std::vector<std::size_t> left;
  std::size_t surplus = axes.size() - first > 3 ? axes.size() - first - 3 : 0;
  if (surplus > 0) choice.notes.push_back("axes of one sample are left out of " + text_of(axes));
  for (std::size_t n = first; n < axes.size(); ++n) {
    if (surplus > 0 && axes[n].size == 1) {
      --surplus;
    } else {
      left.push_back(n);
    }
  }
  if (left.size() > 3 || left.size() < 2) {
    const std::string found = axes.empty() ? axes_found(axes) : "one of " + text_of(axes);
    bad_input(path, "an array of 2 or 3 axes, or one that names its axes x, y, z, channel and time",
              found + (axes.size() > 3 ? " (--channel and --time choose along leading axes)" : ""));
  }
  for (std::size_t n = 0; n < left.size(); ++n) choice.axis.at(left.size() - 1 - n) = left[n];
  return choice;
}

}  // namespace

std::array<std::int64_t, 3> AxisChoice::dims(const std::vector<ArrayAxis>& axes) const {
  std::array<std::int64_t, 3> dims{1, 1, 1};
  for (std::size_t a = kI; a <= kK; ++a) {
    if (axis.at(a) != kNoAxis) dims.at(a) = axes[axis.at(a)].size;
  }
  return dims;
}

void take_dimension_names(std::vector<ArrayAxis>& axes, std::vector<ArrayAxis> named, std::vector<std::string>& notes) {
  const auto is_slices = [](const ArrayAxis& axis) { return kind_of(axis) == AxisKind::kZ; };
  const auto is_unknown = [](const ArrayAxis& axis) { return kind_of(axis) == AxisKind::kOther && axis.size > 1; };
  const auto unknown = std::count_if(named.begin(), named.end(), is_unknown);
  if (are_named(named) && unknown == 1 && std::none_of(named.begin(), named.end(), is_slices)) {
    const auto slices = std::find_if(named.begin(), named.end(), is_unknown);
    notes.push_back("axis " + in_quotes(slices->name) + " is taken for z");
    slices->name = "z";
  } else if (are_named(named) && unknown > 0 && !are_named(axes)) {
    notes.push_back("the names of the axes of " + text_of(named) + " are left out");
    return;
  }
  axes = std::move(named);
}

AxisChoice choose_axes(std::vector<ArrayAxis> axes, const OpenOptions& options, std::string_view path) {
  if (axes.size() > kMostAxes) {
    bad_input(path, "at most " + std::to_string(kMostAxes) + " axes", std::to_string(axes.size()));
  }
  for (const ArrayAxis& axis : axes) {
    if (axis.size < 1) bad_input(path, "axes of at least one sample", text_of(axes));
  }
  const std::size_t slices = take_slices_from(axes, options.slices_from, path);
  AxisChoice choice = are_named(axes) ? choose_named(axes, options, path) : choose_unnamed(axes, options, path);
  choice.place = choice.axis;
  if (slices != kNoAxis) choice.place[kK] = slices;
  return choice;
}

}  // namespace isoweave
