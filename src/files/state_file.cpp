#include "files/state_file.hpp"

#include <algorithm>
#include <vector>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

}  // namespace

void StateWriter::put(std::span<const std::byte> bytes) {
  crc_ = add_to_crc(crc_, bytes);
  file_.write(bytes);
}

void StateWriter::commit() {
  file_.write(std::as_bytes(std::span(&crc_, 1)));
  file_.commit();
}

StateReader::StateReader(const std::string& path, const char* kind)
    : path_(path), kind_(kind), file_(path, std::ios::binary) {
  if (!file_) throw BadInput(path_ + ": expected a " + kind_ + ", found none that can be read");
  check_crc();
}

void StateReader::check_crc() {
  file_.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
  std::uint32_t expected = 0;
  std::uint32_t crc = 0;
  if (size < sizeof(crc)) {
    throw BadInput(path_ + ": expected a " + kind_ + ", found " + std::to_string(size) + " bytes");
  }
  left_ = size - sizeof(crc);
  file_.seekg(0);
  std::vector<std::byte> block(kBlockBytes);
  for (std::uint64_t done = 0; done < left_; done += block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlockBytes, left_ - done)));
    file_.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    crc = add_to_crc(crc, block);
  }
  file_.read(reinterpret_cast<char*>(&expected), sizeof(expected));
  if (!file_) throw BadInput(path_ + ": cannot be read to its end");
  if (crc != expected) throw BadInput(path_ + ": the " + kind_ + " is damaged: its checksum does not fit");
  file_.seekg(0);
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
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw BadInput(path_ + ": cannot be read to its end");
  left_ -= bytes.size();
}

}  // namespace isoweave
