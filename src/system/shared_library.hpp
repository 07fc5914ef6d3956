// Libraries that are loaded while the program runs.
#pragma once

#include <string>

namespace isoweave::system {

// The name under which the system has a version of a library: "libNAME.so.VERSION" on Linux.
std::string library_file(const std::string& name, int version);

// Loads a library, which stays as long as the process. Null where it cannot be loaded. Its names are for find_symbol()
// only.
void* load_library(const std::string& name);

// The address of a name in a library; null where the library does not have it.
void* find_symbol(void* library, const char* name);

}  // namespace isoweave::system
