#include "volume/hdf5_library.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <span>
#include <string_view>

#include "volume/input_file.hpp"
#include "volume/lzf.hpp"
#include "volume/printable.hpp"

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

template <class Function>
void load(void* library, const char* name, Function& function, const std::string& path) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  if (function == nullptr) bad_input(path, "function " + std::string(name) + " in libhdf5", "a library without it");
}

// The library that was found when this one was built, or one of its name.
void* load_library(const std::string& path) {
  const std::filesystem::path built_with = ISOWEAVE_HDF5_LIBRARY;
  for (const std::string& name : {built_with.string(), built_with.filename().string()}) {
    if (void* const library = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
  }
  bad_input(path, "a format of this system",
            "HDF5, whose library " + built_with.filename().string() + " cannot be loaded");
}

Hdf5Functions load_functions(const std::string& path) {
  void* const library = load_library(path);
  Hdf5Functions h5;
// The name is that of the function of this version, whatever macro stands for it.
#define ISOWEAVE_TEXT(name) #name
#define ISOWEAVE_LOAD(name) load(library, ISOWEAVE_TEXT(name), h5.name, path)
  ISOWEAVE_LOAD(H5open);
  ISOWEAVE_LOAD(H5Eget_auto2);
  ISOWEAVE_LOAD(H5Eset_auto2);
  ISOWEAVE_LOAD(H5Ewalk2);
  ISOWEAVE_LOAD(H5Zregister);
  ISOWEAVE_LOAD(H5Zfilter_avail);
  ISOWEAVE_LOAD(H5Fopen);
  ISOWEAVE_LOAD(H5Fclose);
  ISOWEAVE_LOAD(H5Oopen);
  ISOWEAVE_LOAD(H5Oclose);
  ISOWEAVE_LOAD(H5Iget_type);
  ISOWEAVE_LOAD(H5Gget_info);
  ISOWEAVE_LOAD(H5Lget_name_by_idx);
  ISOWEAVE_LOAD(H5Lget_info_by_idx);
  ISOWEAVE_LOAD(H5Dget_space);
  ISOWEAVE_LOAD(H5Dget_type);
  ISOWEAVE_LOAD(H5Dget_create_plist);
  ISOWEAVE_LOAD(H5Dget_storage_size);
  ISOWEAVE_LOAD(H5Dread);
  ISOWEAVE_LOAD(H5Sclose);
  ISOWEAVE_LOAD(H5Screate_simple);
  ISOWEAVE_LOAD(H5Sselect_hyperslab);
  ISOWEAVE_LOAD(H5Sget_simple_extent_type);
  ISOWEAVE_LOAD(H5Sget_simple_extent_ndims);
  ISOWEAVE_LOAD(H5Sget_simple_extent_dims);
  ISOWEAVE_LOAD(H5Sget_simple_extent_npoints);
  ISOWEAVE_LOAD(H5Tclose);
  ISOWEAVE_LOAD(H5Tget_class);
  ISOWEAVE_LOAD(H5Tget_size);
  ISOWEAVE_LOAD(H5Tget_sign);
  ISOWEAVE_LOAD(H5Tget_super);
  ISOWEAVE_LOAD(H5Tget_order);
  ISOWEAVE_LOAD(H5Tget_precision);
  ISOWEAVE_LOAD(H5Tget_offset);
  ISOWEAVE_LOAD(H5Tget_fields);
  ISOWEAVE_LOAD(H5Tget_ebias);
  ISOWEAVE_LOAD(H5Tis_variable_str);
  ISOWEAVE_LOAD(H5Pclose);
  ISOWEAVE_LOAD(H5Pget_layout);
  ISOWEAVE_LOAD(H5Pget_chunk);
  ISOWEAVE_LOAD(H5Pget_nfilters);
  ISOWEAVE_LOAD(H5Pget_filter2);
  ISOWEAVE_LOAD(H5Pget_external_count);
  ISOWEAVE_LOAD(H5Aexists);
  ISOWEAVE_LOAD(H5Aopen);
  ISOWEAVE_LOAD(H5Aclose);
  ISOWEAVE_LOAD(H5Aread);
  ISOWEAVE_LOAD(H5Aget_type);
  ISOWEAVE_LOAD(H5Aget_space);
  ISOWEAVE_LOAD(H5free_memory);
#undef ISOWEAVE_LOAD
#undef ISOWEAVE_TEXT
  if (h5.H5open() < 0) bad_input(path, "a working libhdf5", "one that does not start");
  constexpr H5Z_filter_t kLzf = 32000;
  static const H5Z_class2_t filter{H5Z_CLASS_T_VERS, kLzf, 0, 1, "lzf", nullptr, nullptr, decode_lzf_chunk};
  if (h5.H5Zfilter_avail(kLzf) <= 0) h5.H5Zregister(&filter);
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

}  // namespace

Hdf5Session::Hdf5Session(const std::string& path) : lock_(one_at_a_time()), functions_(functions(path)) {
  functions_.H5Eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
  functions_.H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Session::~Hdf5Session() { functions_.H5Eset_auto2(H5E_DEFAULT, printer_, printer_data_); }

void Hdf5Session::refuse(const std::string& path, const std::string& expected) const {
  std::string message;
  functions_.H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_message, &message);
  bad_input(path, expected, message.empty() ? "damaged data" : isoweave::quoted(message));
}

}  // namespace isoweave
