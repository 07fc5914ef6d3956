#include "volume/formats/hdf5/hdf5_place.hpp"

#include "files/header_text.hpp"

namespace isoweave {
Hdf5Handle open_object(const Hdf5File& file, const std::string& name) {
  return file.session.open_object(file.id, name, file.path);
}

std::optional<std::vector<double>> numbers_in(const Hdf5File& file, const std::string& name) {
  const Hdf5Handle dataset = open_object(file, name);
  if (!dataset || file.session.h5().iget_type(dataset.id()) != H5I_DATASET) return std::nullopt;
  return hdf5_numbers(file.session, dataset.id(), file.path);
}

std::string text_in(const ArrayAttributes& attributes, const std::string& name) {
  std::string text;
  for (const std::string& piece : attributes.texts(name)) text += piece;
  const auto number = text.empty() ? attributes.numbers(name) : std::nullopt;
  if (number && number->size() == 1) text = number_text(number->front());
  return std::string(trimmed(text));
}

std::string step_of_path(const std::string& name, std::size_t from_end) {
  std::string left = name;
  while (from_end-- > 0) left = folder_of_path(left);
  const std::size_t slash = left.rfind('/');
  return slash == std::string::npos ? left : left.substr(slash + 1);
}

std::string folder_of_path(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? std::string() : name.substr(0, slash);
}

std::optional<Hdf5Place> find_hdf5_place(const Hdf5File& file, const std::string& named, const OpenOptions& options) {
  if (std::optional<Hdf5Place> place = imaris_place(file, named, options)) return place;
  if (std::optional<Hdf5Place> place = itk_place(file, named)) return place;
  if (std::optional<Hdf5Place> place = minc_place(file, named)) return place;
  if (std::optional<Hdf5Place> place = dream3d_place(file, named)) return place;
  return vtkhdf_place(file, named);
}

}  // namespace isoweave
