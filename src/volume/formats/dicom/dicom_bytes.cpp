#include "volume/formats/dicom/dicom_bytes.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "files/byte_stream.hpp"

namespace isoweave {
namespace {

class PlainBytes final : public DicomBytes {
 public:
  explicit PlainBytes(FilePtr file) : file_(std::move(file)) {}

  const std::string& path() const override { return file_->path(); }
  std::uint64_t size() const override { return file_->size(); }
  std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) override { return file_->read_at(offset, out); }

 private:
  FilePtr file_;
};

class InflatedBytes final : public DicomBytes {
 public:
  InflatedBytes(FilePtr file, std::uint64_t begin) : file_(std::move(file)), begin_(std::min(begin, file_->size())) {
    size_ = begin_ + open()->skip(std::numeric_limits<std::uint64_t>::max());
    rewind();
  }

  const std::string& path() const override { return file_->path(); }
  std::uint64_t size() const override { return size_; }

  std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size() && offset + done < size_) {
      const std::uint64_t at = offset + done;
      const std::span<std::byte> wanted = out.subspan(done);
      const std::size_t step = at < begin_ ? read_front(at, wanted) : read_block(at - begin_, wanted);
      if (step == 0) break;
      done += step;
    }
    return done;
  }

 private:
  static constexpr std::size_t kBlock = 64 * 1024;

  struct Block {
    std::uint64_t number = ~std::uint64_t{0};
    std::vector<std::byte> bytes;
  };

  std::unique_ptr<ByteStream> open() const {
    return std::make_unique<InflateStream>(std::make_unique<FileStream>(file_, begin_, file_->size()), file_->path(),
                                           InflateStream::Form::kRaw);
  }

  void rewind() {
    stream_ = open();
    next_ = 0;
  }

  std::size_t read_front(std::uint64_t offset, std::span<std::byte> out) const {
    return file_->read_at(offset,
                          out.first(static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), begin_ - offset))));
  }

  // Reads from the block that holds the inflated byte `at`. The block before it is kept, as readers look back at
  // elements.
  std::size_t read_block(std::uint64_t at, std::span<std::byte> out) {
    const std::uint64_t number = at / kBlock;
    if (blocks_[0].number != number && blocks_[1].number != number) {
      if (number < next_) rewind();
      while (next_ <= number) inflate_block();
    }
    const Block& block = blocks_[blocks_[0].number == number ? 0 : 1];
    const auto first = static_cast<std::size_t>(at % kBlock);
    const std::size_t step = std::min(out.size(), block.bytes.size() - std::min(first, block.bytes.size()));
    std::copy_n(block.bytes.begin() + static_cast<std::ptrdiff_t>(first), step, out.begin());
    return step;
  }

  void inflate_block() {
    Block& block = blocks_[next_ % 2];
    block.number = next_++;
    block.bytes.resize(kBlock);
    block.bytes.resize(stream_->read(block.bytes));
  }

  FilePtr file_;
  std::uint64_t begin_;
  std::uint64_t size_ = 0;
  std::unique_ptr<ByteStream> stream_;
  std::uint64_t next_ = 0;  // block of the stream
  std::array<Block, 2> blocks_;
};

}  // namespace

DicomBytesPtr plain_bytes(FilePtr file) { return std::make_shared<PlainBytes>(std::move(file)); }

DicomBytesPtr inflated_bytes(FilePtr file, std::uint64_t begin) {
  return std::make_shared<InflatedBytes>(std::move(file), begin);
}

}  // namespace isoweave
