// Volumes in folders of Zarr, OME-Zarr and N5: finds the array, its axes, and where its samples lie.
#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "volume/formats/chunked/array_coordinates.hpp"
#include "volume/formats/chunked/array_places.hpp"
#include "volume/formats/chunked/array_values.hpp"
#include "volume/formats/chunked/ome_multiscale.hpp"
#include "volume/formats/chunked/open_array.hpp"
#include "volume/formats/chunked/precomputed_info.hpp"
#include "volume/formats/chunked/zarr_node.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/images/slice_files.hpp"

namespace isoweave {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFolders = 4096;
constexpr std::size_t kMostNamed = 12;

// An array, and what the group around it says of it.
struct FoundArray {
  ZarrNode node;
  std::optional<Json> axis_names;
  std::optional<AxisPlaces> places;
  std::vector<std::string> notes;
  std::string part;
};

std::vector<std::string> folders_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored) && !entry->is_symlink(ignored)) names.push_back(entry->path().filename().string());
  }
  if (error) bad_input(folder, "cannot be listed: " + error.message());
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

// s0, s1, ... are the levels of one image in N5.
bool has_n5_levels(ObjectStore& store, const ZarrNode& node) {
  if (node.format != ZarrNode::Format::kN5) return false;
  const std::optional<ZarrNode> largest = open_node(store, node.folder + "/s0");
  return largest && largest->is_array;
}

bool is_image(ObjectStore& store, const ZarrNode& node) {
  const Json* ome = member(node.attributes, "ome");
  return member(ome != nullptr ? *ome : node.attributes, "multiscales") != nullptr || has_n5_levels(store, node);
}

std::size_t axis_count(const ZarrNode& array) {
  const Json* shape = member(array.metadata, array.format == ZarrNode::Format::kN5 ? "dimensions" : "shape");
  return shape == nullptr ? 0 : shape->size();
}

// Arrays and images below a group, by their paths in it; arrays of one axis are none that could be a volume.
std::vector<std::string> images_below(ObjectStore& store, const ZarrNode& root) {
  if (!store.is_local()) {
    bad_input(root.header, "an array or an image, or --dataset with the path of one: no server is asked for lists",
              "a group");
  }
  std::vector<std::string> found;
  std::vector<std::string> open{""};
  for (std::size_t n = 0; n < open.size() && n < kMostFolders; ++n) {
    const std::string above = open[n].empty() ? "" : open[n] + "/";
    for (const std::string& folder : folders_in(root.folder + "/" + open[n])) {
      const std::string path = above + folder;
      const std::optional<ZarrNode> node = open_node(store, root.folder + "/" + path);
      if (node && node->is_array) {
        if (axis_count(*node) > 1) found.push_back(path);
      } else if (node && is_image(store, *node)) {
        found.push_back(path);
      } else {
        open.push_back(path);
      }
    }
  }
  return found;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), kMostNamed); ++n)
    text += (n == 0 ? "" : ", ") + in_quotes(names[n]);
  if (names.size() > kMostNamed) text += " and " + std::to_string(names.size() - kMostNamed) + " more";
  return text;
}

ZarrNode node_at(ObjectStore& store, const std::string& root, const std::string& name, const std::string& header) {
  std::optional<ZarrNode> node = open_node(store, inside(root, name, header));
  if (!node) bad_input(header, "an array or group at " + in_quotes(name), "no metadata of Zarr or N5");
  return std::move(*node);
}

void check_level(const std::optional<std::int64_t>& level, std::size_t levels, const std::string& path) {
  if (level && (*level < 0 || std::cmp_greater_equal(*level, levels))) {
    bad_input(path, "--level below " + std::to_string(levels), std::to_string(*level));
  }
}

void note_levels(FoundArray& array, std::size_t levels, std::int64_t level) {
  if (levels == 1) return;
  array.part = "level " + std::to_string(level);
  array.notes.push_back("level " + std::to_string(level) + " of " + std::to_string(levels) +
                        " is read; --level chooses");
}

FoundArray level_of_image(ObjectStore& store, const ZarrNode& node, const Multiscale& image,
                          const OpenOptions& options) {
  check_level(options.level, image.levels.size(), node.header);
  const std::int64_t number = options.level.value_or(0);
  const Multiscale::Level& level = image.levels[static_cast<std::size_t>(number)];
  FoundArray found{node_at(store, node.folder, level.path, node.header), {}, level.places, {}, {}};
  if (!found.node.is_array) bad_input(node.header, "an array at " + in_quotes(level.path), "a group");
  if (!image.axis_names.is_null()) found.axis_names = image.axis_names;
  note_levels(found, image.levels.size(), number);
  if (open_node(store, node.folder + "/nifti")) {
    found.notes.emplace_back("the NIfTI header beside the levels is not applied");
  }
  return found;
}

// Factors of one level, out of a list for all of them.
const Json* factors_of(const Json& attributes, std::int64_t level) {
  for (const char* key : {"downsamplingFactors", "scales"}) {
    const Json* list = member(attributes, key);
    const auto number = static_cast<std::size_t>(level);
    if (list != nullptr && list->is_array() && number < list->size() && (*list)[number].is_array()) {
      return &(*list)[number];
    }
  }
  return nullptr;
}

// Takes the attributes of all levels for a level that has none of its own.
void take_group_attributes(FoundArray& found, const ZarrNode& group, std::int64_t level) {
  Json& own = found.node.attributes;
  if (!group.attributes.is_object() || !own.is_object()) return;
  const auto says = [&own](const char* key) { return member(own, key) != nullptr; };
  const bool placed =
      says("downsamplingFactors") || says("resolution") || says("pixelResolution") || says("voxel_size");
  const Json* const factors = factors_of(group.attributes, level);
  if (!placed && factors != nullptr) own["downsamplingFactors"] = *factors;
  for (const auto& [key, value] : group.attributes.items()) {
    if (member(own, key) == nullptr) own[key] = value;
  }
  if (level > 0 && !placed && factors == nullptr) {
    found.notes.emplace_back(
        "how much smaller the level is than the image is not given: its spacing is that of level 0");
  }
}

FoundArray level_of_n5(ObjectStore& store, const ZarrNode& node, const OpenOptions& options) {
  std::size_t levels = 1;
  while (open_node(store, node.folder + "/s" + std::to_string(levels))) ++levels;
  check_level(options.level, levels, node.header);
  const std::int64_t number = options.level.value_or(0);
  FoundArray found{node_at(store, node.folder, "s" + std::to_string(number), node.header), {}, {}, {}, {}};
  take_group_attributes(found, node, number);
  note_levels(found, levels, number);
  return found;
}

// N of "sN"; nothing for another name.
std::optional<std::int64_t> n5_level(const std::string& name) {
  if (!name.starts_with('s') || name.find_first_not_of("0123456789", 1) != std::string::npos) return std::nullopt;
  return parse_integer(std::string_view(name).substr(1));
}

// The description that a group gives of an array at `name` in it; nothing where there is none.
std::optional<FoundArray> described_by(const ZarrNode& group, const ZarrNode& array, const std::string& name) {
  FoundArray found{array, {}, {}, {}, {}};
  std::string level = name;
  if (const std::optional<LevelInImage> in_image = find_level(group.attributes, name, group.header)) {
    found.places = in_image->image.levels[in_image->level].places;
    if (!in_image->image.axis_names.is_null()) found.axis_names = in_image->image.axis_names;
    level = std::to_string(in_image->level);
  } else if (const auto number = n5_level(name); number && group.format == ZarrNode::Format::kN5) {
    take_group_attributes(found, group, *number);
  } else {
    return std::nullopt;
  }
  found.notes.push_back("the array is level " + in_quotes(level) + " of the image in a folder above it, which " +
                        "says where its samples lie");
  return found;
}

// An array that was opened by its own folder, as the level of an image that it may be.
FoundArray alone_or_level(ObjectStore& store, const ZarrNode& array) {
  constexpr int kMostAbove = 16;
  std::string name;
  std::optional<FolderAbove> around = store.above(array.folder);
  for (int above = 0; above < kMostAbove && around; ++above, around = store.above(around->folder)) {
    if (!name.empty()) name.insert(0, "/");
    name.insert(0, around->name);
    const std::optional<ZarrNode> group = open_node(store, around->folder);
    if (!group || group->is_array) break;
    if (std::optional<FoundArray> found = described_by(*group, array, name)) return std::move(*found);
  }
  return {array, {}, {}, {}, {}};
}

FoundArray find_array(ObjectStore& store, const ZarrNode& node, const OpenOptions& options) {
  if (node.is_array) {
    if (options.level) bad_input(node.header, "several levels for --level", "an array alone");
    return alone_or_level(store, node);
  }
  if (const std::optional<Multiscale> image = multiscale_of(node.attributes, node.header)) {
    return level_of_image(store, node, *image, options);
  }
  if (has_n5_levels(store, node)) return level_of_n5(store, node, options);
  const std::vector<std::string> images = images_below(store, node);
  if (images.empty()) bad_input(node.header, "an image or array in the group", "none");
  if (images.size() > 1) bad_input(node.header, "--dataset with one of " + listed(images), "no choice");
  FoundArray found = find_array(store, node_at(store, node.folder, images[0], node.header), options);
  found.notes.push_back(in_quotes(images[0]) + " is the only array in the folder, and is read");
  return found;
}

// The steps of pixelResolution (N5 viewer).
void take_pixel_resolution(AxisPlaces& places, const ZarrNode& node, const AxisChoice& choice) {
  const Json* resolution = member(node.attributes, "pixelResolution");
  if (resolution == nullptr || !places.step.empty()) return;
  ZarrNode inner = node;
  inner.attributes = resolution->is_object() ? *resolution : Json{{"dimensions", *resolution}};
  const ArrayAttributes own = attributes_of(inner);
  const auto list = own.numbers("dimensions");
  if (!list || list->size() != choice.at.size()) return;
  places.step = *list;
  const std::vector<std::string> unit = own.texts("unit");
  if (unit.size() == 1) places.units.assign(choice.at.size(), unit[0]);
}

// The steps and the shift that downsamplingFactors make of those of the full size (N5 viewer).
void take_factors(AxisPlaces& places, const ZarrNode& node) {
  const auto factors = attributes_of(node).numbers("downsamplingFactors");
  if (!factors || places.step.size() != factors->size()) return;
  places.begin.resize(factors->size(), 0);
  for (std::size_t n = 0; n < factors->size(); ++n) {
    places.begin[n] += ((*factors)[n] - 1) / 2 * places.step[n];
    places.step[n] *= (*factors)[n];
  }
}

// Where the samples of an array lie by its own attributes.
AxisPlaces own_places(const ZarrNode& node, const AxisChoice& choice) {
  const ArrayAttributes attributes = attributes_of(node);
  const bool is_n5 = node.format == ZarrNode::Format::kN5;
  AxisPlaces places = places_of_attributes(attributes, choice);
  if (is_n5) take_pixel_resolution(places, node, choice);
  take_offset(places, attributes, choice);
  if (is_n5) take_factors(places, node);
  return places;
}

// The folder around an array, where arrays beside it are looked for; nothing where that is none of the caller's.
std::optional<std::string> group_around(ObjectStore& store, const ZarrNode& node, const std::string& folder,
                                        const OpenOptions& options) {
  if (node.folder != folder) {
    const fs::path path(node.folder);
    return (path.has_filename() ? path : path.parent_path()).parent_path().string();
  }
  if (!options.external) return std::nullopt;
  const std::optional<FolderAbove> around = store.above(node.folder);
  return around ? std::optional(around->folder) : std::nullopt;
}

// The attributes that say which values samples stand for. xarray keeps _FillValue as the fill value of Zarr 2, which is
// 0 where nobody chose one.
ArrayAttributes value_attributes(ZarrNode node) {
  const Json* const fill = member(node.metadata, "fill_value");
  const bool by_xarray = node.format == ZarrNode::Format::kZarr2 && node.attributes.is_object() &&
                         member(node.attributes, "_ARRAY_DIMENSIONS") != nullptr;
  const bool chosen = fill != nullptr && fill->is_number() && fill->get<double>() != 0;
  if (by_xarray && chosen && !node.attributes.contains("_FillValue")) node.attributes["_FillValue"] = *fill;
  return attributes_of(node);
}

void check_places(const FoundArray& found, std::size_t axes) {
  const std::size_t said = found.places ? found.places->step.size() : 0;
  if (said == 0 || said == axes) return;
  bad_input(found.node.header, "an array of the " + std::to_string(said) + " axes of its transformations",
            "one of " + std::to_string(axes));
}

// Says which version of the metadata was read, and what was chosen.
void note_parts(VolumeInfo& info, const std::string& version, std::initializer_list<std::string> chosen) {
  for (const std::string& part : chosen) {
    if (!part.empty()) info.part = part + (info.part.empty() ? "" : ", " + info.part);
  }
  if (!version.empty()) info.part += (info.part.empty() ? "version " : ", version ") + version;
}

OpenedVolume open_precomputed(const StorePtr& store, const std::string& folder, const OpenOptions& options) {
  if (!options.dataset.empty()) {
    bad_input(folder, "an array or group at " + in_quotes(options.dataset), "no metadata of Zarr or N5");
  }
  const std::optional<Json> metadata = look_for_json(*store, folder + "/info");
  if (!metadata) {
    bad_input(folder, "the metadata of Zarr, OME-Zarr, N5 or a precomputed volume", store->why_nothing());
  }
  const PrecomputedScale scale = precomputed_scale(store, folder, *metadata, options);
  const AxisChoice choice = choose_axes(scale.array.axes, options, scale.array.header);
  OpenedVolume volume = open_chunks(scale.array, choice);
  volume.info.path = folder;
  place_axes(volume, choice, scale.places);
  std::string level;
  if (scale.scales > 1) {
    level = "level " + std::to_string(scale.scale);
    volume.info.notes.push_back(level + " of " + std::to_string(scale.scales) + " is read; --level chooses");
  }
  note_parts(volume.info, store->identity(scale.array.header), {level});
  return volume;
}

}  // namespace

OpenedVolume open_zarr(const std::string& path, const OpenOptions& options) {
  return open_array(open_folder_store(path, options.external), path, options);
}

OpenedVolume open_array(const StorePtr& store, const std::string& folder, const OpenOptions& options) {
  const std::optional<ZarrNode> root = open_node(*store, inside(folder, options.dataset, folder));
  if (!root) return open_precomputed(store, folder, options);
  const FoundArray found = find_array(*store, *root, options);
  ChunkedArray array = array_of(store, found.node);
  if (found.axis_names) {
    if (found.axis_names->size() != array.axes.size()) {
      bad_input(found.node.header, "an array of the " + std::to_string(found.axis_names->size()) + " axes of its image",
                "one of " + std::to_string(array.axes.size()));
    }
    name_axes(array.axes, &*found.axis_names);
  }
  check_places(found, array.axes.size());
  const std::vector<ArrayAxis> own_names = array.axes;
  if (!found.axis_names) take_dimension_names(array.axes, own_names, array.notes);
  const AxisChoice choice = choose_axes(array.axes, options, array.header);
  AxisPlaces places = found.places ? *found.places : own_places(found.node, choice);
  const auto group =
      found.places || !places.step.empty() ? std::nullopt : group_around(*store, found.node, folder, options);
  if (group) take_coordinates(places, zarr_coordinates(store, found.node, *group, own_names), array.axes, choice);
  OpenedVolume volume = open_chunks(array, choice);
  VolumeInfo& info = volume.info;
  info.path = folder;
  place_axes(volume, choice, places);
  take_values(info, value_attributes(found.node));
  info.notes.insert(info.notes.end(), found.notes.begin(), found.notes.end());
  const std::string dataset = options.dataset.empty() ? "" : "dataset " + options.dataset;
  note_parts(info, store->identity(array.header), {found.part, dataset});
  return volume;
}

}  // namespace isoweave
