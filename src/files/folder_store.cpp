// Objects that are files below a local folder.
#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/external_files.hpp"
#include "files/input_file.hpp"
#include "files/object_store.hpp"

namespace isoweave {
namespace {

namespace fs = std::filesystem;

class FolderStore final : public ObjectStore {
 public:
  // root: no link is followed from this folder to a file outside of it; empty: wherever links lead.
  explicit FolderStore(std::string root) : root_(std::move(root)) {}

  std::optional<std::vector<std::byte>> read(const ObjectPart& part) override {
    if (!open(part.path)) return std::nullopt;
    const std::uint64_t size = open_size();
    if (part.whole && size > part.bytes) {
      bad_input(part.path, "at most " + std::to_string(part.bytes) + " bytes", std::to_string(size));
    }
    const std::uint64_t wanted = part.whole ? size : part.bytes;
    std::vector<std::byte> bytes(static_cast<std::size_t>(std::min(wanted, size - std::min(part.begin, size))));
    if (bytes.size() < wanted || (wanted > 0 && file_->read_at(part.begin, bytes) < wanted)) {
      bad_input(part.path, std::to_string(wanted) + " bytes from byte " + std::to_string(part.begin) + " on", "fewer");
    }
    if (part.whole) file_ = nullptr;
    return bytes;
  }

  std::optional<std::vector<std::byte>> look_for(const ObjectPart& part) override {
    std::error_code error;
    return fs::is_regular_file(part.path, error) ? read(part) : std::nullopt;
  }

  std::optional<std::uint64_t> size(const std::string& path) override {
    return open(path) ? std::optional(open_size()) : std::nullopt;
  }

  std::optional<FolderAbove> above(const std::string& folder) const override {
    std::error_code error;
    fs::path path = fs::absolute(folder, error).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    if (!path.has_relative_path()) return std::nullopt;
    return FolderAbove{path.parent_path().string(), path.filename().string()};
  }

 private:
  // Opens a file, unless it is open since a part of it was read. False where there is none of this name.
  bool open(const std::string& path) {
    if (file_ != nullptr && file_->path() == path) return true;
    file_ = nullptr;
    std::error_code error;
    if (fs::status(path, error).type() == fs::file_type::not_found) return false;
    if (!root_.empty() && path.starts_with(root_)) check_within(path, root_);
    const bool is_empty = fs::is_regular_file(path, error) && fs::is_empty(path, error) && !error;
    if (!is_empty) file_ = open_file(path, "an object in a file");
    return true;
  }

  std::uint64_t open_size() const { return file_ == nullptr ? 0 : file_->size(); }

  std::string root_;
  FilePtr file_;  // none for an empty object
};

}  // namespace

StorePtr open_folder_store(const std::string& folder, bool external) {
  return std::make_shared<FolderStore>(external ? std::string() : folder);
}

}  // namespace isoweave
