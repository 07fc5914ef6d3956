#include "files/state_file.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

}  // namespace

void StateWriter::put(std::span<const std::byte> bytes) {
  crc_ = add_to_crc(crc_, bytes);
  write(bytes);
}

void StateWriter::write(std::span<const std::byte> bytes) {
  if (file_) return file_->write(bytes);
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void StateWriter::commit() {
  write(std::as_bytes(std::span(&crc_, 1)));
  file_->commit();
}

std::vector<std::byte> StateWriter::take() {
  write(std::as_bytes(std::span(&crc_, 1)));
  return std::move(bytes_);
}

StateReader::StateReader(const std::string& path, const char* kind)
    : path_(path), kind_(kind), file_(path, std::ios::binary) {
  if (!file_) throw BadInput(path_ + ": expected a " + kind_ + ", found none that can be read");
  file_.seekg(0, std::ios::end);
  left_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
  check_crc();
}

StateReader::StateReader(std::vector<std::byte> bytes, const std::string& name, const char* kind)
    : path_(name), kind_(kind), bytes_(std::move(bytes)), left_(bytes_.size()) {
  check_crc();
}

void StateReader::check_crc() {
  std::uint32_t expected = 0;
  std::uint32_t crc = 0;
  if (left_ < sizeof(crc)) {
    throw BadInput(path_ + ": expected a " + kind_ + ", found " + std::to_string(left_) + " bytes");
  }
  left_ -= sizeof(crc);
  rewind();
  std::vector<std::byte> block(kBlockBytes);
  for (std::uint64_t done = 0; done < left_; done += block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlockBytes, left_ - done)));
    read(block);
    crc = add_to_crc(crc, block);
  }
  read(std::as_writable_bytes(std::span(&expected, 1)));
  if (crc != expected) throw BadInput(path_ + ": the " + kind_ + " is damaged: its checksum does not fit");
  rewind();
}

void StateReader::rewind() {
  at_ = 0;
  if (file_.is_open()) file_.seekg(0);
}

// Reads bytes of which the caller knows that they are there.
void StateReader::read(std::span<std::byte> bytes) {
  if (!file_.is_open()) {
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes.size(), bytes.begin());
    at_ += bytes.size();
    return;
  }
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw BadInput(path_ + ": cannot be read to its end");
}

void StateReader::require_left(std::uint64_t count, std::uint64_t bytes_each) const {
  if (count <= left_ / bytes_each) return;
  throw BadInput(path_ + ": expected " + std::to_string(count) + " items in the " + kind_ + ", found " +
                 std::to_string(left_ / bytes_each));
}

void StateReader::refuse(const char* expected) const {
  throw BadInput(path_ + ": the " + kind_ + " is damaged: expected " + expected + ", found something else");
}

void StateReader::get(std::span<std::byte> bytes) {
  require_left(bytes.size(), 1);
  read(bytes);
  left_ -= bytes.size();
}

}  // namespace isoweave
