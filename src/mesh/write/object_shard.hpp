// A shard of neuroglancer's objects (neuroglancer_uint64_sharded_v1): what belongs to an object, and behind it its
// manifest. Indices say where the manifests are: one for each minishard, into which objects are dealt out by a hash of
// their numbers, and at the beginning of the file the index of those.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "files/atomic_file.hpp"

namespace isoweave {

class ObjectShard {
 public:
  // Begins the file. There are as many minishards as fit in `minishard_bits` bits.
  ObjectShard(AtomicFile& file, unsigned minishard_bits);

  // The minishard of an object.
  static std::uint64_t minishard_of(std::uint64_t object, unsigned minishard_bits);

  // The bits for so many objects: an index has some five hundred of them.
  static unsigned bits_for(std::uint64_t objects);

  void write(std::span<const std::byte> bytes) { file_.write(bytes); }

  // Completes an object with its manifest. All that was written since the last object belongs to it.
  // @pre Objects come by minishards, and in each by their numbers.
  void add(std::uint64_t object, std::span<const std::byte> manifest);

  // Writes the indices.
  void finish();

 private:
  struct Entry {
    std::uint64_t object, first, count;  // bytes of the manifest, from behind the index at the beginning
  };

  std::uint64_t index_bytes() const { return std::uint64_t{16} << bits_; }
  void write_minishard(std::span<const Entry> entries);

  AtomicFile& file_;
  unsigned bits_;
  std::vector<Entry> entries_;
};

}  // namespace isoweave
