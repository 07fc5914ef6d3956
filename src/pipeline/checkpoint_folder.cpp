#include "isoweave/checkpoint_folder.hpp"

#include <filesystem>
#include <memory>
#include <new>
#include <system_error>

#include "files/atomic_file.hpp"
#include "isoweave/error.hpp"

namespace isoweave {
namespace {

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw CannotWrite(folder + ": cannot be created: " + error.message());
}

// The folder of one of several unfinished meshes.
std::string part_folder(const std::string& folder, std::size_t mesh) {
  return (std::filesystem::path(folder) / ("lod" + std::to_string(mesh))).string();
}

// The folders of a path that are missing, the innermost first.
std::vector<std::filesystem::path> missing_folders(const std::string& folder) {
  std::vector<std::filesystem::path> missing;
  std::error_code ignored;
  for (std::filesystem::path path = folder; !path.empty() && !std::filesystem::exists(path, ignored);
       path = path.parent_path()) {
    missing.push_back(path);
  }
  return missing;
}

// Removes the parts of a mesh in a folder. Without a state they cannot be continued.
void remove_parts(const std::filesystem::path& folder) {
  for (const char* part : {"mesh.part", "faces.part", "positions.part", "normals.part", "values.part"})
    remove_part((folder / part).string());
}

// The folder of a run for as long as the run lasts. Where the run leaves no state, it leaves no parts of meshes either,
// and no folder that was made for it and has nothing in it.
class RunFolder {
 public:
  explicit RunFolder(const std::string& folder) : folder_(folder), made_(missing_folders(folder)) {
    make_folder(folder);
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  RunFolder(RunFolder&&) = delete;
  RunFolder& operator=(RunFolder&&) = delete;

  ~RunFolder() {
    try {
      if (!holds_state(folder_)) clear();
    } catch (const std::bad_alloc&) {  // parts and folders stay
    }
  }

 private:
  void clear() const {
    std::error_code ignored;
    remove_parts(folder_);
    for (std::size_t mesh = 0; std::filesystem::is_directory(part_folder(folder_, mesh), ignored); ++mesh) {
      remove_parts(part_folder(folder_, mesh));
      std::filesystem::remove(part_folder(folder_, mesh), ignored);
    }
    for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, ignored);
  }

  std::string folder_;
  std::vector<std::filesystem::path> made_;
};

struct LockedFolder {
  RunFolder folder;
  CheckpointLock lock;  // its file is gone before the folder is

  explicit LockedFolder(const std::string& path) : folder(path), lock(path) {}
};

}  // namespace

std::shared_ptr<const CheckpointLock> lock_checkpoint_folder(const std::string& folder) {
  const auto locked = std::make_shared<LockedFolder>(folder);
  return {locked, &locked->lock};
}

bool holds_state(const std::string& folder) {
  const std::filesystem::path path(folder);
  return std::filesystem::exists(path / "state-0") || std::filesystem::exists(path / "state-1");
}

std::vector<std::string> part_folders(const std::string& folder, std::size_t meshes) {
  if (meshes == 1 || folder.empty()) return std::vector<std::string>(meshes, folder);
  std::vector<std::string> folders;
  for (std::size_t mesh = 0; mesh < meshes; ++mesh) {
    folders.push_back(part_folder(folder, mesh));
  }
  return folders;
}

void make_part_folder(const std::string& folder) {
  make_folder(folder);
  remove_parts(folder);
}

}  // namespace isoweave
