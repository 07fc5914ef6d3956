// libhdf5, loaded when the first HDF5 file is met: it brings some thirty libraries into the process that other runs do
// not need.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>

namespace isoweave {

// The functions that are used, by their names in hdf5.h; some of those are macros for one of several versions.
struct Hdf5Functions {
  decltype(&::H5open) H5open = nullptr;
  decltype(&::H5Eget_auto2) H5Eget_auto2 = nullptr;
  decltype(&::H5Eset_auto2) H5Eset_auto2 = nullptr;
  decltype(&::H5Ewalk2) H5Ewalk2 = nullptr;
  decltype(&::H5Zregister) H5Zregister = nullptr;
  decltype(&::H5Zfilter_avail) H5Zfilter_avail = nullptr;
  decltype(&::H5Fopen) H5Fopen = nullptr;
  decltype(&::H5Fclose) H5Fclose = nullptr;
  decltype(&::H5Oopen) H5Oopen = nullptr;
  decltype(&::H5Oclose) H5Oclose = nullptr;
  decltype(&::H5Iget_type) H5Iget_type = nullptr;
  decltype(&::H5Gget_info) H5Gget_info = nullptr;
  decltype(&::H5Lget_name_by_idx) H5Lget_name_by_idx = nullptr;
  decltype(&::H5Lget_info_by_idx) H5Lget_info_by_idx = nullptr;
  decltype(&::H5Dget_space) H5Dget_space = nullptr;
  decltype(&::H5Dget_type) H5Dget_type = nullptr;
  decltype(&::H5Dget_create_plist) H5Dget_create_plist = nullptr;
  decltype(&::H5Dget_storage_size) H5Dget_storage_size = nullptr;
  decltype(&::H5Dread) H5Dread = nullptr;
  decltype(&::H5Sclose) H5Sclose = nullptr;
  decltype(&::H5Screate_simple) H5Screate_simple = nullptr;
  decltype(&::H5Sselect_hyperslab) H5Sselect_hyperslab = nullptr;
  decltype(&::H5Sget_simple_extent_type) H5Sget_simple_extent_type = nullptr;
  decltype(&::H5Sget_simple_extent_ndims) H5Sget_simple_extent_ndims = nullptr;
  decltype(&::H5Sget_simple_extent_dims) H5Sget_simple_extent_dims = nullptr;
  decltype(&::H5Sget_simple_extent_npoints) H5Sget_simple_extent_npoints = nullptr;
  decltype(&::H5Tclose) H5Tclose = nullptr;
  decltype(&::H5Tget_class) H5Tget_class = nullptr;
  decltype(&::H5Tget_size) H5Tget_size = nullptr;
  decltype(&::H5Tget_sign) H5Tget_sign = nullptr;
  decltype(&::H5Tget_super) H5Tget_super = nullptr;
  decltype(&::H5Tget_order) H5Tget_order = nullptr;
  decltype(&::H5Tget_precision) H5Tget_precision = nullptr;
  decltype(&::H5Tget_offset) H5Tget_offset = nullptr;
  decltype(&::H5Tget_fields) H5Tget_fields = nullptr;
  decltype(&::H5Tget_ebias) H5Tget_ebias = nullptr;
  decltype(&::H5Tis_variable_str) H5Tis_variable_str = nullptr;
  decltype(&::H5Pclose) H5Pclose = nullptr;
  decltype(&::H5Pget_layout) H5Pget_layout = nullptr;
  decltype(&::H5Pget_chunk) H5Pget_chunk = nullptr;
  decltype(&::H5Pget_nfilters) H5Pget_nfilters = nullptr;
  decltype(&::H5Pget_filter2) H5Pget_filter2 = nullptr;
  decltype(&::H5Pget_external_count) H5Pget_external_count = nullptr;
  decltype(&::H5Aexists) H5Aexists = nullptr;
  decltype(&::H5Aopen) H5Aopen = nullptr;
  decltype(&::H5Aclose) H5Aclose = nullptr;
  decltype(&::H5Aread) H5Aread = nullptr;
  decltype(&::H5Aget_type) H5Aget_type = nullptr;
  decltype(&::H5Aget_space) H5Aget_space = nullptr;
  decltype(&::H5free_memory) H5free_memory = nullptr;
};

// The library while it is being used: by one thread at a time, since most builds of it allow no more, and without
// printing. What the calling program set up for its own use of the library is left as it was.
class Hdf5Session {
 public:
  // Throws BadInput naming `path`, the file that needs the library, when it cannot be loaded.
  explicit Hdf5Session(const std::string& path);
  ~Hdf5Session();
  Hdf5Session(const Hdf5Session&) = delete;
  Hdf5Session& operator=(const Hdf5Session&) = delete;

  const Hdf5Functions& h5() const { return functions_; }

  // Throws BadInput "PATH: expected EXPECTED, found (what the library said of its last failure)".
  [[noreturn]] void refuse(const std::string& path, const std::string& expected) const;

 private:
  std::lock_guard<std::mutex> lock_;
  const Hdf5Functions& functions_;
  H5E_auto2_t printer_ = nullptr;
  void* printer_data_ = nullptr;
};

// An open object of the library, closed at the end of its life, which must lie inside a session.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() { reset(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }

  hid_t id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }
  void reset() {
    if (id_ >= 0) close_(id_);
    id_ = -1;
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

}  // namespace isoweave
