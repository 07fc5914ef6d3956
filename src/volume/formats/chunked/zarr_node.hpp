// Folders of Zarr 2, Zarr 3 and N5: arrays, and groups of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "files/json_file.hpp"
#include "volume/formats/chunked/array_coordinates.hpp"
#include "volume/formats/chunked/chunked_array.hpp"
#include "volume/half_floats.hpp"

namespace isoweave {

struct ZarrNode {
  enum class Format { kZarr2, kZarr3, kN5 };
  Format format = Format::kZarr2;
  bool is_array = false;
  std::string folder;
  std::string header;  // the file of `metadata`
  Json metadata;       // of an array: .zarray, zarr.json or attributes.json
  Json attributes;     // what users and conventions add
};

// Opens a folder. Nothing for a folder without metadata of these formats. Throws BadInput for metadata that cannot be
// read.
std::optional<ZarrNode> open_node(ObjectStore& store, const std::string& folder);

// The array that the metadata describe. Throws BadInput, by name, for metadata that are wrong or not supported.
ChunkedArray array_of(const StorePtr& store, const ZarrNode& node);
ChunkedArray zarr2_array(const ZarrNode& node);
ChunkedArray zarr3_array(const ZarrNode& node);
ChunkedArray n5_array(const ZarrNode& node);

// The attributes that users and conventions add; a number alone counts as a list of one.
ArrayAttributes attributes_of(const ZarrNode& node);

// The coordinates along the axes of an array that have names: arrays of one axis beside it, in a group. An array whose
// type or codec is not read gives no numbers.
std::vector<AxisCoordinates> zarr_coordinates(const StorePtr& store, const ZarrNode& node, const std::string& group,
                                              const std::vector<ArrayAxis>& axes);

// The fill value of an array, as one sample would be stored.
std::array<std::byte, 8> fill_sample(const Json* value, const StoredType& type, bool big_endian,
                                     const std::string& path);

// Names of axes as a list of texts; an entry that is none has no name. Does nothing for another number of names.
void name_axes(std::vector<ArrayAxis>& axes, const Json* names);

// The path of `name` in a folder. Throws BadInput naming `path` for one that leads out of the folder.
std::string inside(const std::string& folder, const std::string& name, const std::string& path);

}  // namespace isoweave
