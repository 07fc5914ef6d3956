// Folders of objects, wherever they lie: files below a local folder, or what a server has below a URL. Readers of
// chunks and of their metadata ask a store, and know nothing of paths and requests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace isoweave {

// A whole object, or some of its bytes.
struct ObjectPart {
  std::string path;         // as messages show it: of the folder that was opened, or beside or below it
  std::uint64_t begin = 0;  // 0 for a whole object
  std::uint64_t bytes = 0;  // of a part, exactly; of a whole object, at most
  bool whole = true;

  bool operator==(const ObjectPart&) const = default;
  bool operator<(const ObjectPart& other) const {
    return std::tie(path, begin, bytes, whole) < std::tie(other.path, other.begin, other.bytes, other.whole);
  }
};

struct FolderAbove {
  std::string folder, name;
};

// Not thread-safe.
class ObjectStore {
 public:
  ObjectStore() = default;
  virtual ~ObjectStore() = default;
  ObjectStore(const ObjectStore&) = delete;
  ObjectStore& operator=(const ObjectStore&) = delete;

  // The bytes, nothing where there is no such object. Throws BadInput for an object that has more bytes than a whole
  // one may have, or not those of the part; for one that is not what it was when another part of it was read; and where
  // it cannot be read.
  virtual std::optional<std::vector<std::byte>> read(const ObjectPart& part) = 0;

  // As read(), of a whole object that is looked for: where a server refuses to say whether there is one, there is none.
  virtual std::optional<std::vector<std::byte>> look_for(const ObjectPart& part) { return read(part); }

  // The number of bytes of an object; nothing where there is none.
  virtual std::optional<std::uint64_t> size(const std::string& path) = 0;

  // Names what will be read next, in that order. A store on a server asks for several at a time, and forgets those that
  // were named before and are not named again.
  virtual void expect(const std::vector<ObjectPart>&) {}

  // Whether paths are those of files, whose folders can be listed.
  virtual bool is_local() const { return true; }

  // The folder around a folder, and its name in there; nothing where there is none.
  virtual std::optional<FolderAbove> above(const std::string& folder) const = 0;

  // The version of an object: a later object of the same path has another one. Empty for a file, whose version the
  // system knows.
  virtual std::string identity(const std::string&) const { return {}; }

  // Why look_for() found nothing, for messages.
  virtual std::string why_nothing() const { return "none"; }

  // The most bytes that the store keeps of what it expects.
  virtual std::uint64_t held_bytes() const { return 0; }
};

using StorePtr = std::shared_ptr<ObjectStore>;

// The store of a local folder. external: links may lead out of it (OpenOptions::external).
StorePtr open_folder_store(const std::string& folder, bool external);

}  // namespace isoweave
