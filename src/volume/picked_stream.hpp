// One volume out of samples with more axes, as they are stored one after another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "files/byte_stream.hpp"
#include "volume/formats/chunked/array_axes.hpp"

namespace isoweave {

// A stream of one block, numbered `index`, out of every `count` blocks of `block` bytes of another stream.
class PickedStream final : public ByteStream {
 public:
  struct Pattern {
    std::uint64_t block = 1;
    std::uint64_t count = 1;
    std::uint64_t index = 0;
  };

  // `bytes`: what is picked in all.
  PickedStream(std::unique_ptr<ByteStream> all, const Pattern& pattern, std::uint64_t bytes);

  std::size_t read(std::span<std::byte> out) override;
  std::uint64_t skip(std::uint64_t count) override;
  bool skips() const override { return all_->skips(); }

 private:
  std::span<const std::byte> fetch(std::uint64_t from, std::size_t count);

  std::unique_ptr<ByteStream> all_;
  Pattern pattern_;
  std::uint64_t bytes_;
  std::uint64_t position_ = 0;  // among the bytes that are picked
  std::uint64_t behind_ = 0;    // byte of all_ behind the buffer
  std::vector<std::byte> buffer_;
};

// The samples along axes i, j and k of `choice`, at its index along all other axes. `axes` are given from the slowest
// to the fastest, as the samples are stored; their product is known to fit. Throws BadInput naming `path` where k, j
// and i do not come in this order, since slices would not lie behind one another.
std::unique_ptr<ByteStream> pick_volume(std::unique_ptr<ByteStream> all, const std::vector<ArrayAxis>& axes,
                                        const AxisChoice& choice, std::size_t sample_bytes, std::string_view path);

// Bytes up to the end of the last sample that pick_volume gives.
std::uint64_t picked_extent(const std::vector<ArrayAxis>& axes, const AxisChoice& choice, std::size_t sample_bytes,
                            std::string_view path);

// Bytes of all samples along `axes`. Throws BadInput unless each axis has a sample and the size fits in 63 bits.
std::uint64_t checked_bytes_of(const std::vector<ArrayAxis>& axes, std::size_t sample_bytes, std::string_view path);

}  // namespace isoweave
