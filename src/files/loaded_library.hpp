// Libraries that are loaded when an input first needs them: what they bring into the process costs other runs time.
#pragma once

#include <string>

namespace isoweave {

// A library, and how an input that needs it is refused without it.
struct LibraryNeed {
  std::string file;      // its name, or the path where it was when this program was built
  std::string package;   // the package of Debian that brings it
  std::string expected;  // as in "expected a format of this system"
  std::string found;     // as in "found HDF5"
};

// Stays loaded as long as the process.
class LoadedLibrary {
 public:
  // Loads the library of this path, or the one that the system has under this name. Throws BadInput naming `path`, the
  // input that needs the library, where there is none.
  LoadedLibrary(std::string path, const LibraryNeed& need);

  // Finds a function. Throws BadInput where the library has none of this name.
  template <class Function>
  void find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(address_of(name));
  }

 private:
  void* address_of(const char* name) const;

  std::string path_, file_name_;
  void* library_ = nullptr;
};

}  // namespace isoweave
