// The "differential data stream" that PVM volumes come in: variable-length differences of bytes to a predictor, of
// data whose bytes were sorted by their place in the sample. Versions: v3d sorts the whole data at once, v3e blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "files/byte_stream.hpp"

namespace isoweave {

// Bits, most significant first, from a file. Copies read on independently.
class BitReader {
 public:
  BitReader(std::shared_ptr<const InputFile> file, std::uint64_t begin);

  // The next `count` bits, at most 16.
  unsigned read(unsigned count);
  void skip(std::uint64_t count);

  // Whether the file holds `count` more bits.
  bool has(std::uint64_t count) const;

 private:
  void refill();

  std::shared_ptr<const InputFile> file_;
  std::uint64_t position_;  // of the byte behind the buffer, in the file
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0;
  std::uint64_t bits_ = 0;
  unsigned available_ = 0;
};

// The bytes of the stream in their sorted order. A copy continues independently: this is how several places of the
// stream are read at once without holding the stream.
class DdsCursor {
 public:
  // `begin` is the byte behind the magic.
  DdsCursor(const std::shared_ptr<const InputFile>& file, std::uint64_t begin);

  unsigned interleave() const { return interleave_; }
  std::uint64_t position() const { return position_; }

  // Decodes exactly out.size() bytes. Throws BadInput when the stream ends before.
  void read(std::span<std::uint8_t> out);
  void skip(std::uint64_t count);

  // Bytes from here to the end, found by skimming; the cursor is then at the end and of no further use.
  std::uint64_t count_rest();

 private:
  bool begin_run();
  std::uint8_t next_byte();

  BitReader bits_;
  std::string path_;
  unsigned interleave_;
  std::size_t strip_;
  std::vector<std::uint8_t> recent_;  // the last strip + 1 bytes, as a ring
  std::size_t newest_ = 0;
  std::uint64_t position_ = 0;
  unsigned run_left_ = 0;
  unsigned run_bits_ = 0;
};

// The original data. Each byte of a sample comes from its own cursor, so memory does not depend on the data's size.
class DdsStream final : public ByteStream {
 public:
  // `block_samples`: samples that were sorted together, 0 for all of them.
  DdsStream(const std::shared_ptr<const InputFile>& file, std::uint64_t begin, std::uint64_t block_samples);

  std::uint64_t total_bytes() const { return total_; }
  std::size_t read(std::span<std::byte> out) override;

  static constexpr std::uint64_t kBlockSamples = 1 << 24;  // of v3e

 private:
  void begin_block();
  void refill();

  std::vector<DdsCursor> cursors_;
  std::uint64_t interleave_;
  std::uint64_t block_bytes_;
  std::uint64_t total_;
  std::uint64_t next_ = 0;       // first byte that is not in chunk_
  std::uint64_t block_end_ = 0;  // end of the block that the cursors stand in
  std::vector<std::byte> chunk_;
  std::size_t chunk_used_ = 0;
  std::vector<std::uint8_t> plane_;
};

}  // namespace isoweave
