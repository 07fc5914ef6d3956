#include "files/waiting_bytes.hpp"

#include <algorithm>

#include "parallel/size.hpp"

namespace isoweave {

std::uint64_t WaitingFile::append(std::span<const std::byte> bytes) {
  const std::scoped_lock lock(mutex_);
  if (!file_) file_.emplace(open_scratch_in(folder_, path_), path_);
  const std::uint64_t first = file_->size();
  file_->write(bytes);
  return first;
}

void WaitingFile::read_back(std::uint64_t first, std::span<std::byte> bytes) {
  const std::scoped_lock lock(mutex_);
  if (!bytes.empty()) file_->read_back(first, bytes);
}

void WaitingFile::free(std::uint64_t first, std::uint64_t count) {
  const std::scoped_lock lock(mutex_);
  if (file_) file_->free(first, count);
}

WaitingBytes::~WaitingBytes() {
  for (const std::uint64_t block : blocks_) file_->free(block, kBlock);
}

void WaitingBytes::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), to_size(kBlock) - last_.size());
    last_.insert(last_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    bytes = bytes.subspan(taken);
    if (last_.size() < kBlock) return;
    blocks_.push_back(file_->append(last_));
    last_.clear();
  }
}

void WaitingBytes::read_back(std::uint64_t first, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const std::uint64_t block = first / kBlock, at = first % kBlock;
    const std::size_t taken = std::min(bytes.size(), to_size(kBlock - at));
    if (block < blocks_.size()) {
      file_->read_back(blocks_[to_size(block)] + at, bytes.first(taken));
    } else {
      std::copy_n(last_.begin() + static_cast<std::ptrdiff_t>(at), taken, bytes.begin());
    }
    first += taken;
    bytes = bytes.subspan(taken);
  }
}

}  // namespace isoweave
