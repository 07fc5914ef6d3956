#include "volume/formats/chunked/ome_multiscale.hpp"

#include <filesystem>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

// position = scale * index + translation, per axis.
void apply(AxisPlaces& places, const Json& transformation, const std::string& path) {
  const std::string type = text_member(transformation, "type");
  if (type == "identity") return;
  if (type != "scale" && type != "translation") {
    bad_input(path, "coordinate transformations scale and translation", in_quotes(type));
  }
  const std::optional<std::vector<double>> list = numbers_of(member(transformation, type));
  if (!list) bad_input(path, "a list of finite numbers as '" + type + "'", "none");
  if (places.step.empty()) places.step.assign(list->size(), 1);
  if (places.begin.empty()) places.begin.assign(list->size(), 0);
  if (list->size() != places.step.size() || list->size() != places.begin.size()) {
    bad_input(path, "transformations of as many axes as the others", std::to_string(list->size()));
  }
  for (std::size_t n = 0; n < list->size(); ++n) {
    if (type == "scale") {
      places.step[n] *= (*list)[n];
      places.begin[n] *= (*list)[n];
    } else {
      places.begin[n] += (*list)[n];
    }
  }
}

void apply_all(AxisPlaces& places, const Json* transformations, const std::string& path) {
  if (transformations == nullptr || transformations->is_null()) return;
  if (!transformations->is_array()) bad_input(path, "a list of coordinateTransformations", "something else");
  for (const Json& transformation : *transformations) apply(places, transformation, path);
}

// Axes are objects since 0.4, names in 0.3, and always t, c, z, y, x before.
void take_axes(Multiscale& image, std::vector<std::string>& units, const Json* axes, const std::string& version) {
  if (axes == nullptr || !axes->is_array()) {
    if (version == "0.1" || version == "0.2") image.axis_names = {"t", "c", "z", "y", "x"};
    return;
  }
  image.axis_names = Json::array();
  for (const Json& axis : *axes) {
    const std::string type = text_member(axis, "type");
    // An axis may have any name if its type says that it is the channel.
    const bool plain = type == "channel" || type == "time";
    image.axis_names.push_back(axis.is_string() ? axis.get<std::string>() : plain ? type : text_member(axis, "name"));
    units.push_back(text_member(axis, "unit"));
  }
}

// The list of images; nothing where the attributes describe none.
const Json* images_of(const Json& attributes, const std::string& path) {
  const Json* ome = member(attributes, "ome");
  const Json* images = member(ome != nullptr ? *ome : attributes, "multiscales");
  if (images == nullptr) return nullptr;
  if (!images->is_array() || images->empty()) bad_input(path, "an image in 'multiscales'", "none");
  return images;
}

Multiscale read_image(const Json& json, const std::string& path) {
  const Json* datasets = member(json, "datasets");
  if (datasets == nullptr || !datasets->is_array() || datasets->empty()) {
    bad_input(path, "datasets in 'multiscales'", "none");
  }
  Multiscale image;
  std::vector<std::string> units;
  take_axes(image, units, member(json, "axes"), text_member(json, "version"));
  for (const Json& dataset : *datasets) {
    Multiscale::Level level;
    level.path = text_member(dataset, "path");
    if (level.path.empty()) bad_input(path, "a path for every dataset in 'multiscales'", "none");
    level.places.units = units;
    apply_all(level.places, member(dataset, "coordinateTransformations"), path);
    apply_all(level.places, member(json, "coordinateTransformations"), path);
    image.levels.push_back(std::move(level));
  }
  return image;
}

// A path without dots and without a blank end.
std::string plain_path(const std::string& path) {
  std::string plain = std::filesystem::path(path).lexically_normal().generic_string();
  while (plain.ends_with('/')) plain.pop_back();
  return plain;
}

}  // namespace

std::optional<Multiscale> multiscale_of(const Json& attributes, const std::string& path) {
  const Json* images = images_of(attributes, path);
  if (images == nullptr) return std::nullopt;
  Multiscale image = read_image((*images)[0], path);
  if (images->size() > 1) {
    for (Multiscale::Level& level : image.levels) {
      level.places.notes.push_back("the first of " + std::to_string(images->size()) +
                                   " images in 'multiscales' is read");
    }
  }
  return image;
}

std::optional<LevelInImage> find_level(const Json& attributes, const std::string& dataset, const std::string& path) {
  const Json* images = images_of(attributes, path);
  for (std::size_t n = 0; images != nullptr && n < images->size(); ++n) {
    const Json* datasets = member((*images)[n], "datasets");
    if (datasets == nullptr || !datasets->is_array()) continue;
    for (std::size_t level = 0; level < datasets->size(); ++level) {
      if (plain_path(text_member((*datasets)[level], "path")) != plain_path(dataset)) continue;
      return LevelInImage{read_image((*images)[n], path), level};
    }
  }
  return std::nullopt;
}

}  // namespace isoweave
