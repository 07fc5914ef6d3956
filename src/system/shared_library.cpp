#include "system/shared_library.hpp"

#include <dlfcn.h>

namespace isoweave::system {

std::string library_file(const std::string& name, int version) {
#ifdef __APPLE__
  return "lib" + name + "." + std::to_string(version) + ".dylib";
#else
  return "lib" + name + ".so." + std::to_string(version);
#endif
}

void* load_library(const std::string& name) { return ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL); }

void* find_symbol(void* library, const char* name) { return ::dlsym(library, name); }

}  // namespace isoweave::system
