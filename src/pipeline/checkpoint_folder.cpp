#include "isoweave/checkpoint_folder.hpp"

#include <filesystem>
#include <system_error>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw CannotWrite(folder + ": cannot be created: " + error.message());
}

}  // namespace

CheckpointLock lock_checkpoint_folder(const std::string& folder) {
  make_folder(folder);
  return CheckpointLock(folder);
}

bool holds_state(const std::string& folder) {
  const std::filesystem::path path(folder);
  return std::filesystem::exists(path / "state-0") || std::filesystem::exists(path / "state-1");
}

std::vector<std::string> part_folders(const std::string& folder, std::size_t meshes) {
  if (meshes == 1 || folder.empty()) return std::vector<std::string>(meshes, folder);
  std::vector<std::string> folders;
  for (std::size_t mesh = 0; mesh < meshes; ++mesh) {
    folders.push_back((std::filesystem::path(folder) / ("lod" + std::to_string(mesh))).string());
  }
  return folders;
}

void make_part_folder(const std::string& folder) {
  make_folder(folder);
  std::error_code ignored;
  for (const char* part : {"mesh.part", "faces.part", "positions.part", "normals.part", "values.part"})
    std::filesystem::remove(std::filesystem::path(folder) / part, ignored);
}

void remove_part_folders(const std::vector<std::string>& folders) {
  std::error_code ignored;
  for (const std::string& folder : folders) {
    if (folders.size() > 1) std::filesystem::remove(folder, ignored);
  }
}

}  // namespace isoweave
