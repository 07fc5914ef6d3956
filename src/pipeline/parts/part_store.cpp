#include "pipeline/parts/part_store.hpp"

#include <utility>

namespace isoweave {
namespace {

// Blocks in the order of layers.
BlockIndex by_layer(const BlockIndex& block) { return {block[2], block[1], block[0]}; }

}  // namespace

PartStore::Address PartStore::address_of(std::uint64_t id, std::size_t stage) const {
  const std::array<std::int64_t, 3> point = numbering_.place(id).low;
  while (stage + 1 < stages() && grids_[stage].block_of(2, point[2]) < closed_[stage]) ++stage;
  return {stage, grids_[stage].block_of(point)};
}

void PartStore::hand_on(ZonePart part, std::size_t stage) {
  std::vector<Address> addresses;
  std::map<std::pair<std::size_t, BlockIndex>, std::size_t> numbers;
  std::vector<SplitPart> split = split_part(std::move(part), [&](std::uint64_t id) {
    const Address address = address_of(id, stage);
    const auto [number, is_new] = numbers.try_emplace({address.stage, by_layer(address.block)}, addresses.size());
    if (is_new) addresses.push_back(address);
    return number->second;
  });
  for (SplitPart& one : split) put(addresses[one.owner], std::move(one.part));
}

void PartStore::put(const Address& address, ZonePart part) {
  vertices_ += part.vertices.size();
  triangles_ += part.triangles.size();
  std::vector<WaitingPart>& waiting = waiting_[address.stage][by_layer(address.block)];
  if (scratch_) {
    waiting.emplace_back(std::move(part), *scratch_);
  } else {
    waiting.emplace_back(std::move(part));
  }
}

std::vector<BlockIndex> PartStore::blocks(std::size_t stage, std::int64_t layer) const {
  std::vector<BlockIndex> blocks;
  for (const auto& [index, parts] : waiting_[stage]) {
    if (index[0] == layer) blocks.push_back(by_layer(index));
  }
  return blocks;
}

std::vector<ZonePart> PartStore::take(std::size_t stage, const BlockIndex& block) {
  const auto found = waiting_[stage].find(by_layer(block));
  std::vector<ZonePart> parts;
  move_out(found->second, parts);
  waiting_[stage].erase(found);
  return parts;
}

std::vector<ZonePart> PartStore::take_all() {
  std::vector<ZonePart> parts;
  for (auto& stage : waiting_) {
    for (auto& [index, waiting] : stage) move_out(waiting, parts);
    stage.clear();
  }
  return parts;
}

void PartStore::move_out(std::vector<WaitingPart>& waiting, std::vector<ZonePart>& parts) {
  for (WaitingPart& one : waiting) {
    vertices_ -= one.vertices();
    triangles_ -= one.triangles();
    parts.push_back(one.take(shape_));
  }
}

std::uint64_t PartStore::bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& stage : waiting_) {
    for (const auto& [index, parts] : stage) {
      for (const WaitingPart& part : parts) bytes += part.bytes();
    }
  }
  return bytes;
}

void PartStore::list_labels(std::size_t level, std::vector<std::uint32_t*>& labels) {
  for (auto& stage : waiting_) {
    for (auto& [index, parts] : stage) {
      for (WaitingPart& part : parts) part.list_labels(level, labels);
    }
  }
}

}  // namespace isoweave
