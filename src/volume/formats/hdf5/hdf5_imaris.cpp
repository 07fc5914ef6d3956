// Imaris: a dataset for every resolution, time and channel, padded to whole chunks, and the extent of the image.
#include <cmath>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/formats/hdf5/hdf5_place.hpp"

namespace isoweave {
namespace {

constexpr const char* kImarisImage = "/DataSetInfo/Image";
constexpr const char* kLevels = "/DataSet";

struct Choice {
  std::int64_t level = 0;
  std::int64_t time = 0;
  std::int64_t channel = 0;
};

std::string level_path(const Choice& choice) {
  return std::string(kLevels) + "/ResolutionLevel " + std::to_string(choice.level);
}
std::string time_path(const Choice& choice) { return level_path(choice) + "/TimePoint " + std::to_string(choice.time); }
std::string channel_path(const Choice& choice) {
  return time_path(choice) + "/Channel " + std::to_string(choice.channel);
}

std::int64_t links_in(const Hdf5File& file, const std::string& name) {
  const Hdf5Handle group = open_object(file, name);
  H5G_info_t info{};
  if (!group || file.session.h5().gget_info(group.id(), &info) < 0) return 0;
  return static_cast<std::int64_t>(info.nlinks);
}

// Takes an index among `count` objects of one kind.
std::int64_t choose(Hdf5Place& place, const std::optional<std::int64_t>& asked, std::int64_t count,
                    const std::string& word, const std::string& path) {
  if (asked && (*asked < 0 || *asked >= count)) {
    bad_input(path, "--" + word + " below " + std::to_string(count), std::to_string(*asked));
  }
  const std::int64_t number = asked.value_or(0);
  if (count <= 1) return number;
  place.part += (place.part.empty() ? "" : ", ") + word + " " + std::to_string(number);
  if (!asked) {
    place.notes.push_back("the first of " + std::to_string(count) + " along " + word + " is read; --" + word +
                          " chooses");
  }
  return number;
}

// The number behind the blank of "TimePoint 3".
std::optional<std::int64_t> number_behind(const std::string& step, std::string_view word) {
  if (!step.starts_with(word) || step.size() <= word.size() + 1) return std::nullopt;
  return parse_integer(std::string_view(step).substr(word.size() + 1));
}

std::optional<Choice> named_choice(const std::string& named) {
  const auto channel = number_behind(step_of_path(named, 1), "Channel");
  const auto time = number_behind(step_of_path(named, 2), "TimePoint");
  const auto level = number_behind(step_of_path(named, 3), "ResolutionLevel");
  if (!channel || !time || !level) return std::nullopt;
  return Choice{*level, *time, *channel};
}

// Samples that count along x, y or z: of the channel, or of the image for its full size; else all that are `stored`.
std::int64_t size_along(Hdf5Place& place, const ArrayAttributes& channel, const std::string& of_image,
                        std::int64_t stored, const std::string& axis, const std::string& path) {
  std::string text = text_in(channel, "ImageSize" + axis);
  if (text.empty()) text = of_image;
  if (text.empty()) {
    place.notes.push_back("ImageSize" + axis + " is not given, and samples that fill up chunks are read as well");
    return stored;
  }
  const auto size = parse_integer(text);
  if (!size || *size < 1) bad_input(path, "a size of at least 1 as ImageSize" + axis, in_quotes(text));
  return *size;
}

// The shape of a dataset of three axes.
std::vector<std::int64_t> shape_of(const Hdf5File& file, const std::string& name) {
  const Hdf5Handle dataset = open_object(file, name);
  if (!dataset) bad_input(file.path, "a dataset " + in_quotes(name), "none");
  std::vector<std::int64_t> shape = describe_dataset(file.session, dataset.id(), name).shape;
  if (shape.size() != 3) bad_input(file.path, "3 axes in " + in_quotes(name), std::to_string(shape.size()));
  return shape;
}

// The extent reaches from the outer side of the first sample to that of the last.
void take_extent(Hdf5Place& place, const ArrayAttributes& image, std::size_t axis, std::int64_t samples) {
  const auto least = parse_double(text_in(image, "ExtMin" + std::to_string(axis)));
  const auto most = parse_double(text_in(image, "ExtMax" + std::to_string(axis)));
  if (!least || !most || *least == *most) {
    place.notes.push_back("the spacing of axis " + std::to_string(axis) + " is not given and taken as 1");
    return;
  }
  const double step = (*most - *least) / static_cast<double>(samples);
  place.axes.steps[axis][axis] = step;
  place.axes.origin[axis] = *least + step / 2;
}

}  // namespace

std::optional<Hdf5Place> imaris_place(const Hdf5File& file, const std::string& named, const OpenOptions& options) {
  const std::optional<Choice> given = named_choice(named);
  if (!named.empty() && !given) return std::nullopt;
  const Hdf5Handle image = open_object(file, kImarisImage);
  if (!image || !open_object(file, level_path({}))) return std::nullopt;
  Hdf5Place place;
  place.format = "Imaris";
  Choice choice;
  if (named.empty()) {
    place.chosen = true;
    choice.level = choose(place, options.level, links_in(file, kLevels), "level", file.path);
    choice.time = choose(place, options.time, links_in(file, level_path(choice)), "time", file.path);
    choice.channel = choose(place, options.channel, links_in(file, time_path(choice)), "channel", file.path);
  } else {
    choice = *given;
  }
  place.dataset = channel_path(choice) + "/Data";
  if (!named.empty() && named != place.dataset) return std::nullopt;
  const Hdf5Handle channel = open_object(file, channel_path(choice));
  if (!channel) bad_input(file.path, "a group " + in_quotes(channel_path(choice)), "none");
  const ArrayAttributes of_image = hdf5_attributes(file.session, image.id());
  const ArrayAttributes of_channel = hdf5_attributes(file.session, channel.id());
  const std::vector<std::int64_t> stored = shape_of(file, place.dataset);
  place.axis_names = {"z", "y", "x"};
  place.shape.assign(3, 1);
  constexpr std::array<const char*, 3> kAxes{"X", "Y", "Z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string of_full_size = choice.level == 0 ? text_in(of_image, kAxes[axis]) : std::string();
    place.shape[2 - axis] = size_along(place, of_channel, of_full_size, stored[2 - axis], kAxes[axis], file.path);
    take_extent(place, of_image, axis, place.shape[2 - axis]);
  }
  const std::string unit = text_in(of_image, "Unit");
  place.units.fill(unit.empty() ? "um" : unit);
  return place;
}

}  // namespace isoweave
