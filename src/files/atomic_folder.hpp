// Output folders that are complete or absent.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace isoweave {

// A folder that appears under its name only on commit(). Until then it is `.NAME.XXXXXX.partial` beside it, which the
// destructor removes with all that is in it. All failures are CannotWrite.
class AtomicFolder {
 public:
  // Throws what check_free() throws.
  explicit AtomicFolder(const std::string& path);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  // Throws unless the name is free, or that of an empty folder.
  static void check_free(const std::string& path);

  // Creates a file in the folder.
  void write_file(const std::string& name, std::span<const std::byte> bytes);

  // Creates a folder in the folder.
  void make_folder(const std::string& name) const;

  // The path under which a file of this name can be written into the folder until it is committed.
  std::string file(const std::string& name) const { return temporary_ + "/" + name; }

  void commit();

 private:
  std::string path_;       // that links lead to, without slashes at the end
  std::string temporary_;  // empty once it was renamed
};

std::string without_slashes(std::string path);

}  // namespace isoweave
