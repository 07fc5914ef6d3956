// HDF5 files for tests, written through the library itself.
#pragma once

#include <hdf5.h>

#include "volume_helpers.hpp"

namespace isoweave::testing {

using Shape = std::vector<hsize_t>;

// The library under test and its tests are one process: the one that was loaded is the one that is linked.
class Writer {
 public:
  explicit Writer(std::string path, hsize_t user_block = 0) : path_(std::move(path)) {
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, user_block);
    file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
    H5Pclose(creation);
  }
  ~Writer() { H5Fclose(file_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  hid_t file() const { return file_; }

  // A dataset of 1, 2, 3, ... `set_up` changes its creation properties.
  template <class Sample>
  void put(
      const std::string& name, const Shape& shape, hid_t type, hid_t native,
      const std::function<void(hid_t)>& set_up = [](hid_t) {}) {
    std::size_t count = 1;
    for (const hsize_t size : shape) count *= size;
    std::vector<Sample> samples(count);
    for (std::size_t n = 0; n < count; ++n) samples[n] = static_cast<Sample>(n + 1);
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE), links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    set_up(creation);
    const hid_t dataset = H5Dcreate2(file_, name.c_str(), type, space, links, creation, H5P_DEFAULT);
    H5Dwrite(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, samples.data());
    H5Dclose(dataset);
    H5Pclose(links);
    H5Pclose(creation);
    H5Sclose(space);
  }

  void put_int16(
      const std::string& name, const Shape& shape, const std::function<void(hid_t)>& set_up = [](hid_t) {}) {
    put<std::int16_t>(name, shape, H5T_STD_I16LE, H5T_NATIVE_INT16, set_up);
  }

  void put_numbers(const std::string& object, const std::string& name, const std::vector<double>& values) {
    const hsize_t count = values.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t attribute = H5Acreate_by_name(file_, object.c_str(), name.c_str(), H5T_IEEE_F32BE, space, H5P_DEFAULT,
                                              H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, values.data());
    H5Aclose(attribute);
    H5Sclose(space);
  }

  // A dataset of doubles.
  void put_values(const std::string& name, const Shape& shape, const std::vector<double>& values) {
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t dataset = H5Dcreate2(file_, name.c_str(), H5T_IEEE_F64BE, space, links, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Pclose(links);
    H5Sclose(space);
  }

  // Samples 100 n + `base` over those of a dataset.
  void put_samples(const std::string& name, const Shape& shape, std::int16_t base) {
    std::size_t count = 1;
    for (const hsize_t size : shape) count *= size;
    std::vector<std::int16_t> samples(count);
    for (std::size_t n = 0; n < count; ++n)
      samples[n] = static_cast<std::int16_t>(100 * n + static_cast<std::size_t>(base));
    const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_INT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, samples.data());
    H5Dclose(dataset);
  }

  // Attaches datasets as scales of the axes of another, as H5DSattach_scale does; "": none.
  void put_scales(const std::string& object, const std::vector<std::string>& names) {
    const hsize_t count = names.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr), type = H5Tvlen_create(H5T_STD_REF_OBJ);
    const hid_t attribute =
        H5Acreate_by_name(file_, object.c_str(), "DIMENSION_LIST", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    std::vector<hobj_ref_t> references(names.size());
    std::vector<hvl_t> lists(names.size());
    for (std::size_t n = 0; n < names.size(); ++n) {
      if (names[n].empty()) continue;
      H5Rcreate(&references[n], file_, names[n].c_str(), H5R_OBJECT, -1);
      lists[n] = {1, &references[n]};
    }
    H5Awrite(attribute, type, lists.data());
    H5Aclose(attribute);
    H5Tclose(type);
    H5Sclose(space);
  }

  // A link to an object of another file; the groups around it are made.
  void put_link(const std::string& name, const std::string& file, const std::string& object) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    H5Lcreate_external(file.c_str(), object.c_str(), file_, name.c_str(), links, H5P_DEFAULT);
    H5Pclose(links);
  }

  void put_group(const std::string& name) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    H5Gclose(H5Gcreate2(file_, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT));
    H5Pclose(links);
  }

  // A text attribute of one character each, as Imaris writes them.
  void put_letters(const std::string& object, const std::string& name, const std::string& text) {
    const hsize_t count = text.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, 1);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    const hid_t attribute =
        H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, text.data());
    H5Aclose(attribute);
    H5Tclose(type);
    H5Sclose(space);
  }

  void put_text(const std::string& object, const std::string& name, const std::string& text, bool fixed) {
    const hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, fixed ? text.size() : H5T_VARIABLE);
    const hid_t attribute =
        H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const char* const value = text.c_str();
    H5Awrite(attribute, type, fixed ? static_cast<const void*>(value) : static_cast<const void*>(&value));
    H5Aclose(attribute);
    H5Tclose(type);
    H5Sclose(space);
  }

 private:
  std::string path_;
  hid_t file_ = -1;
};

inline std::function<void(hid_t)> chunks(
    const Shape& shape, const std::function<void(hid_t)>& filters = [](hid_t) {}) {
  return [shape, filters](hid_t creation) {
    H5Pset_chunk(creation, static_cast<int>(shape.size()), shape.data());
    filters(creation);
  };
}

inline std::vector<std::int16_t> counting(std::size_t count) {
  std::vector<std::int16_t> samples(count);
  for (std::size_t n = 0; n < count; ++n) samples[n] = static_cast<std::int16_t>(n + 1);
  return samples;
}

}  // namespace isoweave::testing
