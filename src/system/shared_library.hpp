// Libraries that are loaded while the program runs.
#pragma once

#include <string>

namespace isoweave::system {

// A library stays for as long as the process; null where it cannot be loaded. Its names are for find_symbol() only.
void* load_library(const std::string& name);

// Null where the library has no such name.
void* find_symbol(void* library, const char* name);

}  // namespace isoweave::system
