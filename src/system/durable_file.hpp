// How files come to be complete, or never: files without a name, names that are given later, data that is on the disk,
// locks that end with their holder. What fails returns -1 or false and leaves the reason in errno.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace isoweave::system {

// A file that no folder lists, which the system frees however the process ends, and which can be given a name; -1 where
// a file system has no such thing.
int create_unnamed(const std::string& folder);

// The same for what only its owner may read; it may be impossible to give it a name, but there are such files anywhere.
int create_private(const std::string& folder);

// A path that other libraries can open what is open by.
std::string path_of(int descriptor);

// Gives a name to what is open, or to what a path leads to.
bool give_name(int descriptor, const std::string& name);
bool link_path(const std::string& path, const std::string& name);

bool make_folder(const std::string& path);

// Takes the place of a file that has the new name.
bool rename(const std::string& from, const std::string& to);

bool remove_name(const std::string& path);

// The data are on the disk afterwards.
bool sync_file(int descriptor);

// The names in a folder are there after a crash. True for a folder that may be written and not read, and for a file
// system without this: that leaves it to the system.
bool sync_names(const std::string& folder);

// Makes the file end, and stand, at `end`.
bool cut_off(int descriptor, std::uint64_t end);

// Copies from the beginning of one file to where the other stands, as far as the system does so by itself; returns how
// far that was.
std::uint64_t copy_within_system(int from, int to, std::uint64_t bytes);

// Holds what is open against all others that do so, in this process, too, until it is closed. False when somebody else
// holds it; nothing where that cannot be done.
std::optional<bool> try_lock(int descriptor);

}  // namespace isoweave::system
