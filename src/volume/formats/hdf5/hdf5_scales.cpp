#include "volume/formats/hdf5/hdf5_scales.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "files/quoted.hpp"

namespace isoweave {
namespace {

constexpr const char* kList = "DIMENSION_LIST";

// Whether the attribute is a list of references to objects for each axis.
bool is_list_of_scales(const Hdf5Functions& h5, hid_t attribute, hid_t type, std::size_t axes) {
  const Hdf5Handle space(h5.aget_space(attribute), h5.sclose);
  const bool lists = type >= 0 && h5.tget_class(type) == H5T_VLEN;
  const Hdf5Handle entry(lists ? h5.tget_super(type) : -1, h5.tclose);
  return space && entry && h5.tget_class(entry.id()) == H5T_REFERENCE &&
         h5.tget_size(entry.id()) == sizeof(hobj_ref_t) &&
         std::cmp_equal(h5.sget_simple_extent_npoints(space.id()), axes);
}

// The first scale of each axis. References are to objects of the same file.
std::vector<Hdf5Handle> scales_of(const Hdf5Functions& h5, hid_t dataset, std::size_t axes) {
  std::vector<Hdf5Handle> scales(axes);
  if (h5.aexists(dataset, kList) <= 0) return scales;
  const Hdf5Handle attribute(h5.aopen(dataset, kList, kDefaultProperties), h5.aclose);
  const Hdf5Handle type(attribute ? h5.aget_type(attribute.id()) : -1, h5.tclose);
  if (!attribute || !is_list_of_scales(h5, attribute.id(), type.id(), axes)) return scales;
  std::vector<hvl_t> lists(axes, hvl_t{0, nullptr});
  if (h5.aread(attribute.id(), type.id(), lists.data()) < 0) return scales;
  for (std::size_t n = 0; n < axes; ++n) {
    if (lists[n].p == nullptr) continue;
    if (lists[n].len > 0) {
      scales[n] = Hdf5Handle(h5.rdereference(dataset, kDefaultProperties, H5R_OBJECT, lists[n].p), h5.oclose);
    }
    h5.free_memory(lists[n].p);
  }
  return scales;
}

// The last step of the path of an object.
std::string name_of_object(const Hdf5Functions& h5, hid_t object) {
  std::array<char, 1024> path{};
  const ssize_t length = h5.iget_name(object, path.data(), path.size());
  return length > 0 && static_cast<std::size_t>(length) < path.size() ? step_of_path(path.data(), 0) : std::string();
}

// The numbers of a dataset of one axis. netCDF-4 keeps a dimension without coordinates as a dataset of nothing that
// says so.
AxisCoordinates coordinates_in(const Hdf5File& file, hid_t object, const std::string& name) {
  if (file.session.h5().iget_type(object) != H5I_DATASET) return {};
  const ArrayAttributes attributes = hdf5_attributes(file.session, object);
  if (text_in(attributes, "NAME").starts_with("This is a netCDF dimension but not a netCDF variable")) return {};
  if (describe_dataset(file.session, object, name).shape.size() != 1) return {};
  return coordinates_of(name, hdf5_numbers(file.session, object, file.path).value_or(std::vector<double>()),
                        attributes);
}

AxisCoordinates coordinates_beside(const Hdf5File& file, const std::string& dataset, const ArrayAxis& axis) {
  if (axis.name.empty() || axis.name.find('/') != std::string::npos) return {};
  const Hdf5Handle object = open_object(file, folder_of_path(dataset) + "/" + axis.name);
  if (!object) return {};
  AxisCoordinates found = coordinates_in(file, object.id(), axis.name);
  return std::cmp_equal(found.values.size(), axis.size) ? std::move(found) : AxisCoordinates();
}

// NeXus keeps the scaling of a dataset in datasets beside the dataset.
void note_nexus(const Hdf5File& file, const std::string& dataset, std::vector<std::string>& notes) {
  const std::string folder = folder_of_path(dataset);
  const Hdf5Handle group = open_object(file, folder.empty() ? "/" : folder);
  if (!group || text_in(hdf5_attributes(file.session, group.id()), "NX_class") != "NXdata") return;
  const std::string beside = folder + "/", own = step_of_path(dataset, 0) + "_";
  for (const std::string& name :
       {own + "scaling_factor", own + "offset", std::string("scaling_factor"), std::string("offset")}) {
    if (open_object(file, beside + name)) notes.push_back("the dataset " + in_quotes(name) + " is not applied");
  }
}

}  // namespace

Hdf5Scales take_hdf5_scales(const Hdf5File& file, hid_t dataset, const std::string& name,
                            std::vector<ArrayAxis>& axes) {
  Hdf5Scales scales;
  const Hdf5Functions& h5 = file.session.h5();
  const std::vector<Hdf5Handle> attached = scales_of(h5, dataset, axes.size());
  std::vector<ArrayAxis> named = axes;
  for (std::size_t n = 0; n < axes.size(); ++n) {
    if (!attached[n]) {
      scales.coordinates.push_back(coordinates_beside(file, name, axes[n]));
      continue;
    }
    const std::string of_scale = name_of_object(h5, attached[n].id());
    scales.coordinates.push_back(coordinates_in(file, attached[n].id(), of_scale));
    if (named[n].name.empty()) named[n].name = of_scale;
  }
  take_dimension_names(axes, std::move(named), scales.notes);
  note_nexus(file, name, scales.notes);
  return scales;
}

}  // namespace isoweave
