// Files that are complete or absent, for what a program writes beside its meshes: reports, pages, tables.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#pragma GCC visibility push(default)
namespace isoweave {

// A file that appears under its name only on commit(). Until then it lies in the same folder without a name, and is
// gone however the process ends. Where the file system cannot do that it is `.NAME.XXXXXX.partial`, which the
// destructor removes. A file that had the name before stays untouched until commit(). Not thread-safe.
class OutputFile {
 public:
  // Opens the file. An error that would keep it from being written is found now, before what is to be written is
  // computed in vain.
  // @throws CannotWrite when the name is empty, a folder or not a regular file, and when the folder is missing or
  //   read-only
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) noexcept;

  // Appends bytes.
  // @throws CannotWrite
  void write(std::span<const std::byte> bytes);

  // Completes the file: its bytes are durable, as many as were written, and then it gets its name.
  // @pre Called once, and nothing is written afterwards.
  // @throws CannotWrite
  void commit();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace isoweave
#pragma GCC visibility pop
