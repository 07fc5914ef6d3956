// libhdf5, loaded when the first HDF5 file is met: it brings some thirty libraries into the process that other runs do
// not need.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>

namespace isoweave {

// The functions that are used, by their names in hdf5.h; some of those are macros for one of several versions.
// clang-format off
#define ISOWEAVE_HDF5_FUNCTIONS(use) \
  use(H5open) use(H5Eget_auto2) use(H5Eset_auto2) use(H5Ewalk2) use(H5Zregister) use(H5Zfilter_avail) \
  use(H5Fopen) use(H5Fclose) use(H5Oopen) use(H5Oclose) use(H5Iget_type) use(H5Gget_info) \
  use(H5Lget_name_by_idx) use(H5Lget_info_by_idx) use(H5Dget_space) use(H5Dget_type) use(H5Dget_create_plist) \
  use(H5Dget_storage_size) use(H5Dread) use(H5Sclose) use(H5Screate_simple) use(H5Sselect_hyperslab) \
  use(H5Sget_simple_extent_type) use(H5Sget_simple_extent_ndims) use(H5Sget_simple_extent_dims) \
  use(H5Sget_simple_extent_npoints) use(H5Tclose) use(H5Tget_class) use(H5Tget_size) use(H5Tget_sign) \
  use(H5Tget_super) use(H5Tget_native_type) use(H5Tis_variable_str) use(H5Pclose) use(H5Pget_layout) \
  use(H5Pget_chunk) use(H5Pget_nfilters) use(H5Pget_filter2) use(H5Pget_external_count) use(H5Aexists) \
  use(H5Aopen) use(H5Aclose) use(H5Aread) use(H5Aget_type) use(H5Aget_space) use(H5free_memory)
// clang-format on

struct Hdf5Functions {
#define ISOWEAVE_DECLARE(function) decltype (&::function)(function) = nullptr;
  ISOWEAVE_HDF5_FUNCTIONS(ISOWEAVE_DECLARE)
#undef ISOWEAVE_DECLARE
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
