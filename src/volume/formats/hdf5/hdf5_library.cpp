#include "volume/formats/hdf5/hdf5_library.hpp"

#include <cstdlib>
#include <span>
#include <string_view>

#include "files/input_file.hpp"
#include "files/loaded_library.hpp"
#include "files/quoted.hpp"
#include "volume/formats/chunked/lzf.hpp"

namespace isoweave {
namespace {

// The filter of h5py, which libhdf5 does not have. It is given the bytes of a chunk as its third value.
std::size_t decode_lzf_chunk(unsigned flags, std::size_t values, const unsigned* value, std::size_t stored,
                             std::size_t* room, void** buffer) {
  const bool decodes = (flags & H5Z_FLAG_REVERSE) != 0;
  constexpr std::size_t kBytesAt = 2;
  if (!decodes || values <= kBytesAt || value[kBytesAt] / kLzfRatio > stored) return 0;
  const std::size_t bytes = value[kBytesAt];
  void* const decoded = std::malloc(bytes);  // the library frees it
  if (decoded == nullptr) return 0;
  const std::span from(static_cast<const std::byte*>(*buffer), stored);
  if (!decode_lzf(from, std::span(static_cast<std::byte*>(decoded), bytes))) {
    std::free(decoded);
    return 0;
  }
  std::free(*buffer);
  *buffer = decoded;
  *room = bytes;
  return bytes;
}

Hdf5Functions load_functions(const std::string& path) {
  const LoadedLibrary library(path, {ISOWEAVE_HDF5_LIBRARY, "libhdf5-103-1", "a format of this system", "HDF5"});
  Hdf5Functions h5;
// The name is that of the function of this version, whatever macro stands for it.
#define ISOWEAVE_TEXT(name) #name
#define ISOWEAVE_LOAD(name, member) library.find(ISOWEAVE_TEXT(name), h5.member)
  ISOWEAVE_LOAD(H5open, open);
  ISOWEAVE_LOAD(H5Eget_auto2, eget_auto2);
  ISOWEAVE_LOAD(H5Eset_auto2, eset_auto2);
  ISOWEAVE_LOAD(H5Ewalk2, ewalk2);
  ISOWEAVE_LOAD(H5Zregister, zregister);
  ISOWEAVE_LOAD(H5Zfilter_avail, zfilter_avail);
  ISOWEAVE_LOAD(H5Fopen, fopen);
  ISOWEAVE_LOAD(H5Fclose, fclose);
  ISOWEAVE_LOAD(H5Oopen, oopen);
  ISOWEAVE_LOAD(H5Oclose, oclose);
  ISOWEAVE_LOAD(H5Iget_type, iget_type);
  ISOWEAVE_LOAD(H5Iget_name, iget_name);
  ISOWEAVE_LOAD(H5Rdereference2, rdereference);
  ISOWEAVE_LOAD(H5Gget_info, gget_info);
  ISOWEAVE_LOAD(H5Lget_name_by_idx, lget_name_by_idx);
  ISOWEAVE_LOAD(H5Lget_info_by_idx, lget_info_by_idx);
  ISOWEAVE_LOAD(H5Dget_space, dget_space);
  ISOWEAVE_LOAD(H5Dget_type, dget_type);
  ISOWEAVE_LOAD(H5Dget_create_plist, dget_create_plist);
  ISOWEAVE_LOAD(H5Dget_storage_size, dget_storage_size);
  ISOWEAVE_LOAD(H5Dread, dread);
  ISOWEAVE_LOAD(H5Sclose, sclose);
  ISOWEAVE_LOAD(H5Screate_simple, screate_simple);
  ISOWEAVE_LOAD(H5Sselect_hyperslab, sselect_hyperslab);
  ISOWEAVE_LOAD(H5Sget_simple_extent_type, sget_simple_extent_type);
  ISOWEAVE_LOAD(H5Sget_simple_extent_ndims, sget_simple_extent_ndims);
  ISOWEAVE_LOAD(H5Sget_simple_extent_dims, sget_simple_extent_dims);
  ISOWEAVE_LOAD(H5Sget_simple_extent_npoints, sget_simple_extent_npoints);
  ISOWEAVE_LOAD(H5Tclose, tclose);
  ISOWEAVE_LOAD(H5Tget_class, tget_class);
  ISOWEAVE_LOAD(H5Tget_size, tget_size);
  ISOWEAVE_LOAD(H5Tget_sign, tget_sign);
  ISOWEAVE_LOAD(H5Tget_super, tget_super);
  ISOWEAVE_LOAD(H5Tget_order, tget_order);
  ISOWEAVE_LOAD(H5Tget_precision, tget_precision);
  ISOWEAVE_LOAD(H5Tget_offset, tget_offset);
  ISOWEAVE_LOAD(H5Tget_fields, tget_fields);
  ISOWEAVE_LOAD(H5Tget_ebias, tget_ebias);
  ISOWEAVE_LOAD(H5Tis_variable_str, tis_variable_str);
  ISOWEAVE_LOAD(H5P_CLS_LINK_ACCESS_ID_g, link_access);
  ISOWEAVE_LOAD(H5Pcreate, pcreate);
  ISOWEAVE_LOAD(H5Pset_elink_cb, pset_elink_cb);
  ISOWEAVE_LOAD(H5Pclose, pclose);
  ISOWEAVE_LOAD(H5Pget_layout, pget_layout);
  ISOWEAVE_LOAD(H5Pget_chunk, pget_chunk);
  ISOWEAVE_LOAD(H5Pget_nfilters, pget_nfilters);
  ISOWEAVE_LOAD(H5Pget_filter2, pget_filter2);
  ISOWEAVE_LOAD(H5Pget_external_count, pget_external_count);
  ISOWEAVE_LOAD(H5Aexists, aexists);
  ISOWEAVE_LOAD(H5Aopen, aopen);
  ISOWEAVE_LOAD(H5Aclose, aclose);
  ISOWEAVE_LOAD(H5Aread, aread);
  ISOWEAVE_LOAD(H5Aget_type, aget_type);
  ISOWEAVE_LOAD(H5Aget_space, aget_space);
  ISOWEAVE_LOAD(H5free_memory, free_memory);
#undef ISOWEAVE_LOAD
#undef ISOWEAVE_TEXT
  if (h5.open() < 0) bad_input(path, "a working libhdf5", "one that does not start");
  constexpr H5Z_filter_t kLzf = 32000;
  static const H5Z_class2_t kFilter{H5Z_CLASS_T_VERS, kLzf, 0, 1, "lzf", nullptr, nullptr, decode_lzf_chunk};
  if (h5.zfilter_avail(kLzf) <= 0) h5.zregister(&kFilter);
  return h5;
}

std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

const Hdf5Functions& functions(const std::string& path) {
  static const Hdf5Functions kFunctions = load_functions(path);
  return kFunctions;
}

// Keeps the first message of a walk.
herr_t keep_message(unsigned, const H5E_error2_t* error, void* data) {
  auto& message = *static_cast<std::string*>(data);
  if (message.empty() && error->desc != nullptr) message = error->desc;
  return 0;
}

// Called for every link into another file. Notes where the link leads, and fails.
herr_t refuse_link(const char*, const char*, const char* file, const char* object, unsigned*, hid_t, void* data) {
  *static_cast<std::string*>(data) = in_quotes(object) + " in " + in_quotes(file);
  return -1;
}

}  // namespace

Hdf5Session::Hdf5Session(const std::string& path) : lock_(one_at_a_time()), functions_(functions(path)) {
  functions_.eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
  functions_.eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  links_ = Hdf5Handle(functions_.pcreate(*functions_.link_access), functions_.pclose);
  const bool ready = links_ && functions_.pset_elink_cb(links_.id(), refuse_link, &link_out_) >= 0;
  if (!ready) bad_input(path, "a libhdf5 that can leave links alone", "another");
}

Hdf5Session::~Hdf5Session() {
  links_.reset();
  functions_.eset_auto2(H5E_DEFAULT, printer_, printer_data_);
}

Hdf5Handle Hdf5Session::open_object(hid_t above, const std::string& name, const std::string& path) const {
  link_out_.clear();
  Hdf5Handle object(functions_.oopen(above, name.c_str(), links_.id()), functions_.oclose);
  if (link_out_.empty()) return object;
  bad_input(path, in_quotes(name) + " in the file itself", "a link to " + link_out_ + ", which is not followed");
}

void Hdf5Session::refuse(const std::string& path, const std::string& expected) const {
  std::string message;
  functions_.ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_message, &message);
  bad_input(path, expected, message.empty() ? "damaged data" : in_quotes(message));
}

}  // namespace isoweave
