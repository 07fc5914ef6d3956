#include "files/loaded_library.hpp"

#include <filesystem>
#include <utility>

#include "files/input_file.hpp"
#include "system/shared_library.hpp"

namespace isoweave {

LoadedLibrary::LoadedLibrary(std::string path, const LibraryNeed& need)
    : path_(std::move(path)), file_name_(std::filesystem::path(need.file).filename().string()) {
  for (const std::string& name : {need.file, file_name_}) {
    library_ = system::load_library(name);
    if (library_ != nullptr) return;
  }
  bad_input(path_, need.expected,
            need.found + ", whose library " + file_name_ + " cannot be loaded (Debian's package " + need.package + ")");
}

void* LoadedLibrary::address_of(const char* name) const {
  void* const address = system::find_symbol(library_, name);
  if (address == nullptr)
    bad_input(path_, "function " + std::string(name) + " in " + file_name_, "a library without it");
  return address;
}

}  // namespace isoweave
