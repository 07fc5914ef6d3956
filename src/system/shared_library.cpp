#include "system/shared_library.hpp"

#include <dlfcn.h>

namespace isoweave::system {

void* load_library(const std::string& name) { return ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL); }

void* find_symbol(void* library, const char* name) { return ::dlsym(library, name); }

}  // namespace isoweave::system
