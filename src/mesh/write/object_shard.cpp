#include "mesh/write/object_shard.hpp"

#include <algorithm>
#include <bit>

#include "files/murmur_hash.hpp"
#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

void store_u64(std::byte*& out, std::uint64_t value) {
  store_u32(out, static_cast<std::uint32_t>(value));
  store_u32(out, static_cast<std::uint32_t>(value >> 32U));
}

}  // namespace

ObjectShard::ObjectShard(AtomicFile& file, unsigned minishard_bits) : file_(file), bits_(minishard_bits) {
  constexpr std::uint64_t kAtOnce = 1 << 16;
  const std::vector<std::byte> zeros(kAtOnce);
  for (std::uint64_t done = 0; done < index_bytes(); done += kAtOnce) {
    file_.write(std::span(zeros).first(std::min(kAtOnce, index_bytes() - done)));
  }
}

std::uint64_t ObjectShard::minishard_of(std::uint64_t object, unsigned minishard_bits) {
  return minishard_bits == 0 ? 0 : murmur_hash(object) & ((std::uint64_t{1} << minishard_bits) - 1);
}

unsigned ObjectShard::bits_for(std::uint64_t objects) { return static_cast<unsigned>(std::bit_width(objects / 512)); }

void ObjectShard::add(std::uint64_t object, std::span<const std::byte> manifest) {
  entries_.push_back({object, file_.size() - index_bytes(), manifest.size()});
  file_.write(manifest);
}

// Numbers, places and sizes, each as the difference from what follows on the entry before.
void ObjectShard::write_minishard(std::span<const Entry> entries) {
  std::vector<std::byte> bytes(24 * entries.size());
  std::byte* out = bytes.data();
  const Entry none{0, 0, 0};
  const Entry* before = &none;
  for (const Entry& entry : entries) {
    store_u64(out, entry.object - before->object);
    before = &entry;
  }
  before = &none;
  for (const Entry& entry : entries) {
    store_u64(out, entry.first - before->first - before->count);
    before = &entry;
  }
  for (const Entry& entry : entries) store_u64(out, entry.count);
  file_.write(bytes);
}

void ObjectShard::finish() {
  std::vector<std::byte> index(index_bytes());
  std::byte* out = index.data();
  auto first = entries_.begin();
  for (std::uint64_t minishard = 0; minishard < std::uint64_t{1} << bits_; ++minishard) {
    const auto end = std::find_if(first, entries_.end(),
                                  [&](const Entry& entry) { return minishard_of(entry.object, bits_) != minishard; });
    store_u64(out, file_.size() - index_bytes());
    write_minishard({first, end});
    store_u64(out, file_.size() - index_bytes());
    first = end;
  }
  file_.overwrite(0, index);
}

}  // namespace isoweave
