#include "files/atomic_folder.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "files/atomic_file.hpp"
#include "isoweave/error.hpp"
#include "system/durable_file.hpp"
#include "system/file_facts.hpp"

namespace isoweave {
namespace {

constexpr int kAttempts = 100;

[[noreturn]] void cannot_write(const std::string& path, const std::string& what, int error) {
  throw CannotWrite(path + ": " + what + ": " + std::generic_category().message(error));
}

// Makes the temporary folder beside the folder itself, as a rename cannot leave the file system.
std::string make_temporary(const std::string& path) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::string name = temporary_name(path);
    if (system::make_folder(name)) return name;
    if (errno != EEXIST) cannot_write(path, "cannot create a folder in '" + folder_of(path) + "'", errno);
  }
  throw CannotWrite(path + ": no free temporary name in '" + folder_of(path) + "'");
}

}  // namespace

std::string without_slashes(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

void AtomicFolder::check_free(const std::string& path) {
  const std::filesystem::path name = without_slashes(path);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(name, error);
  if (status.type() == std::filesystem::file_type::not_found) return;
  const bool empty = std::filesystem::is_directory(status) && std::filesystem::is_empty(name, error);
  if (!empty || error) throw CannotWrite(path + ": exists, expected nothing or an empty folder of that name");
}

AtomicFolder::AtomicFolder(const std::string& path) : path_(system::follow_links(without_slashes(path))) {
  check_free(path);
  temporary_ = make_temporary(path_);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove_all(temporary_, ignored);
}

void AtomicFolder::make_folder(const std::string& name) const {
  if (!system::make_folder(file(name))) cannot_write(path_, "cannot create the folder '" + name + "' in it", errno);
}

void AtomicFolder::write_file(const std::string& name, std::span<const std::byte> bytes) {
  AtomicFile out(file(name));
  out.write(bytes);
  out.commit();
}

void AtomicFolder::commit() {
  // A rename replaces an empty folder of that name, and nothing else.
  if (!system::rename(temporary_, path_)) cannot_write(path_, "cannot be renamed into place", errno);
  temporary_.clear();
  sync_folder(path_, path_);
}

}  // namespace isoweave
