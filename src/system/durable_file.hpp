// The means by which files become complete, or never appear: files without a name, names that are given later, data
// that is on the disk, locks that end with their holder. A function that fails returns -1 or false and leaves the
// reason in errno.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace isoweave::system {

// A file that no folder lists, which the system frees however the process ends, and which can be given a name; -1 where
// a file system has no such thing.
int create_unnamed(const std::string& folder);

// A file without a name that only its owner may read. It may be impossible to give it a name, but every file system has
// such files.
int create_private(const std::string& folder);

// A path by which other libraries can open an open file.
std::string path_of(int descriptor);

// Gives a name to an open file, or to the file that a path leads to.
bool give_name(int descriptor, const std::string& name);
bool link_path(const std::string& path, const std::string& name);

bool make_folder(const std::string& path);

// Renames a file. A file that has the new name is replaced.
bool rename(const std::string& from, const std::string& to);

bool remove_name(const std::string& path);

// Puts the data on the disk.
bool sync_file(int descriptor);

// Makes the names in a folder survive a crash. Returns true for a folder that may be written and not read, and for a
// file system without this function: the system takes care of it there.
bool sync_names(const std::string& folder);

// Makes the file end, and stand, at `end`.
bool cut_off(int descriptor, std::uint64_t end);

// Gives the room of bytes of a file back to the system, where it can do that. They must not be read any more.
void free_bytes(int descriptor, std::uint64_t first, std::uint64_t count);

// Copies from the beginning of one file to the place where the other stands, as far as the system does so by itself.
// Returns the number of bytes copied.
std::uint64_t copy_within_system(int from, int to, std::uint64_t bytes);

// Locks an open file against all others that lock it, in this process, too, until it is closed. Returns false when
// another holder has the lock; nothing where files cannot be locked.
std::optional<bool> try_lock(int descriptor);

}  // namespace isoweave::system
