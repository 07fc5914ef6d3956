// Libraries that are loaded while the program runs.
#pragma once

#include <string>

namespace isoweave::system {

// Loads a library, which stays as long as the process. Null where it cannot be loaded. Its names are for find_symbol()
// only.
void* load_library(const std::string& name);

// The address of a name in a library; null where the library does not have it.
void* find_symbol(void* library, const char* name);

}  // namespace isoweave::system
