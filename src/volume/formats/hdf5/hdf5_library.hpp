// libhdf5, loaded when the first HDF5 file is met: it brings some thirty libraries into the process that other runs do
// not need.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>

namespace isoweave {

inline constexpr hid_t kDefaultProperties = 0;  // H5P_DEFAULT, which some versions define with a cast

// The functions that are used: those of hdf5.h, without their H5 in front. Some names there are macros for one of
// several versions.
struct Hdf5Functions {
  decltype(&::H5open) open = nullptr;
  decltype(&::H5Eget_auto2) eget_auto2 = nullptr;
  decltype(&::H5Eset_auto2) eset_auto2 = nullptr;
  decltype(&::H5Ewalk2) ewalk2 = nullptr;
  decltype(&::H5Zregister) zregister = nullptr;
  decltype(&::H5Zfilter_avail) zfilter_avail = nullptr;
  decltype(&::H5Fopen) fopen = nullptr;
  decltype(&::H5Fclose) fclose = nullptr;
  decltype(&::H5Oopen) oopen = nullptr;
  decltype(&::H5Oclose) oclose = nullptr;
  decltype(&::H5Iget_type) iget_type = nullptr;
  decltype(&::H5Iget_name) iget_name = nullptr;
  decltype(&::H5Rdereference2) rdereference = nullptr;
  decltype(&::H5Gget_info) gget_info = nullptr;
  decltype(&::H5Lget_name_by_idx) lget_name_by_idx = nullptr;
  decltype(&::H5Lget_info_by_idx) lget_info_by_idx = nullptr;
  decltype(&::H5Dget_space) dget_space = nullptr;
  decltype(&::H5Dget_type) dget_type = nullptr;
  decltype(&::H5Dget_create_plist) dget_create_plist = nullptr;
  decltype(&::H5Dget_storage_size) dget_storage_size = nullptr;
  decltype(&::H5Dread) dread = nullptr;
  decltype(&::H5Sclose) sclose = nullptr;
  decltype(&::H5Screate_simple) screate_simple = nullptr;
  decltype(&::H5Sselect_hyperslab) sselect_hyperslab = nullptr;
  decltype(&::H5Sget_simple_extent_type) sget_simple_extent_type = nullptr;
  decltype(&::H5Sget_simple_extent_ndims) sget_simple_extent_ndims = nullptr;
  decltype(&::H5Sget_simple_extent_dims) sget_simple_extent_dims = nullptr;
  decltype(&::H5Sget_simple_extent_npoints) sget_simple_extent_npoints = nullptr;
  decltype(&::H5Tclose) tclose = nullptr;
  decltype(&::H5Tget_class) tget_class = nullptr;
  decltype(&::H5Tget_size) tget_size = nullptr;
  decltype(&::H5Tget_sign) tget_sign = nullptr;
  decltype(&::H5Tget_super) tget_super = nullptr;
  decltype(&::H5Tget_order) tget_order = nullptr;
  decltype(&::H5Tget_precision) tget_precision = nullptr;
  decltype(&::H5Tget_offset) tget_offset = nullptr;
  decltype(&::H5Tget_fields) tget_fields = nullptr;
  decltype(&::H5Tget_ebias) tget_ebias = nullptr;
  decltype(&::H5Tis_variable_str) tis_variable_str = nullptr;
  decltype(&::H5P_CLS_LINK_ACCESS_ID_g) link_access = nullptr;  // a class of properties
  decltype(&::H5Pcreate) pcreate = nullptr;
  decltype(&::H5Pset_elink_cb) pset_elink_cb = nullptr;
  decltype(&::H5Pclose) pclose = nullptr;
  decltype(&::H5Pget_layout) pget_layout = nullptr;
  decltype(&::H5Pget_chunk) pget_chunk = nullptr;
  decltype(&::H5Pget_nfilters) pget_nfilters = nullptr;
  decltype(&::H5Pget_filter2) pget_filter2 = nullptr;
  decltype(&::H5Pget_external_count) pget_external_count = nullptr;
  decltype(&::H5Aexists) aexists = nullptr;
  decltype(&::H5Aopen) aopen = nullptr;
  decltype(&::H5Aclose) aclose = nullptr;
  decltype(&::H5Aread) aread = nullptr;
  decltype(&::H5Aget_type) aget_type = nullptr;
  decltype(&::H5Aget_space) aget_space = nullptr;
  decltype(&::H5free_memory) free_memory = nullptr;
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

  // The object of a name below another object; none where there is no such path. Every object is opened here: no link
  // into another file is followed, neither on the way to an object nor as the target of a link inside the file. Throws
  // BadInput naming `path`, the file, where there is one.
  Hdf5Handle open_object(hid_t above, const std::string& name, const std::string& path) const;

  // Throws BadInput "PATH: expected EXPECTED, found (what the library said of its last failure)".
  [[noreturn]] void refuse(const std::string& path, const std::string& expected) const;

 private:
  std::lock_guard<std::mutex> lock_;
  const Hdf5Functions& functions_;
  Hdf5Handle links_;              // how links are followed
  mutable std::string link_out_;  // where a link into another file leads, once one was met
  H5E_auto2_t printer_ = nullptr;
  void* printer_data_ = nullptr;
};

}  // namespace isoweave
