// Datasets of an HDF5 file: which there are, and what one says of itself. To be used inside a session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "volume/formats/chunked/array_places.hpp"
#include "volume/formats/hdf5/hdf5_library.hpp"
#include "volume/half_floats.hpp"

namespace isoweave {

struct Hdf5Dataset {
  std::string name;                 // its path in the file
  std::vector<std::int64_t> shape;  // from the slowest axis to the fastest
  std::optional<StoredType> type;   // nothing: of a kind that is not read
  bool big_endian = false;
  std::string type_text;  // for messages
};

struct Hdf5Contents {
  std::vector<Hdf5Dataset> datasets;
  std::string link_out;  // the path of a link into another file, if there is any
};

// All datasets of numbers and of 2 axes or more that hard links lead to, a bounded number of them.
Hdf5Contents find_datasets(const Hdf5Session& session, hid_t file, const std::string& path);

// The description of an open dataset. Throws BadInput naming `path` where the dataset is not an array.
Hdf5Dataset describe_dataset(const Hdf5Session& session, hid_t dataset, const std::string& name);

// Attributes of an object, as long as the session lasts.
ArrayAttributes hdf5_attributes(const Hdf5Session& session, hid_t object);

// How a dataset is stored. Throws BadInput naming `path` where its samples lie in other files.
H5D_layout_t layout_in_file(const Hdf5Session& session, hid_t dataset, const std::string& path);

// The numbers of a small dataset; nothing for one of other things, or of too many. Throws as layout_in_file does.
std::optional<std::vector<double>> hdf5_numbers(const Hdf5Session& session, hid_t dataset, const std::string& path);

// Names of the axes as ilastik (axistags) or HDF5's dimension scales (DIMENSION_LABELS) give them.
void name_hdf5_axes(const ArrayAttributes& attributes, std::vector<ArrayAxis>& axes);

}  // namespace isoweave
