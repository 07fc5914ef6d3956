// Sources that tell what they hold, and that can hand out rows of slices, as a slice may be larger than the memory
// there is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "isoweave/volume.hpp"
#include "volume/gaps.hpp"
#include "volume/samples.hpp"

namespace isoweave {

// One sample as it is in memory; those of fewer bytes leave the rest alone.
using SampleBytes = std::array<std::byte, 8>;

class BufferedSource : public SliceSource {
 public:
  // The most bytes that reading holds beside the memory it is given: a band of slices, a strip, a decoded slice. A
  // source of another source adds what that one holds.
  virtual std::uint64_t held_bytes() const { return 0; }

  // The samples of the file that a box of samples was made of, for messages: in a part they lie elsewhere, and a volume
  // made smaller has a block of them for each of its own.
  virtual Region in_file(const Region& samples) const { return samples; }
};

class RowSource : public BufferedSource {
 public:
  // Reads `count` rows of slice k, from row `first` on. As read() does for slices, it goes forward only: once a row of
  // a slice has been read, the slices before it are behind.
  virtual void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) = 0;

  // Reads samples of row j of slice k from sample i on, likewise: samples before are behind. Only where
  // reads_parts_of_rows() says so.
  virtual void read_part_of_row(std::int64_t k, std::int64_t j, std::int64_t i, std::span<std::byte> out);

  // Says that no samples beside a box will be read, before any is. Returns whether the source holds no others then, and
  // has to be read by parts of rows.
  virtual bool narrow(const Region&) { return false; }

  // The bytes of a row from which on a part of it is read faster than all of it, where parts can be read.
  virtual std::size_t long_row() const { return std::size_t{1} << 14; }

  // The value of every sample, where it is known without reading any.
  virtual std::optional<SampleBytes> constant() const { return std::nullopt; }

  // Where a source of chunks asks which of them are needed; null where all are read.
  virtual Gaps* gaps() { return nullptr; }

  // The range of the samples of a slice, and their CRC-32, where an index tells them. Samples of such a source may
  // stand for others, which were not read.
  virtual const SampleRange* range(std::int64_t) const { return nullptr; }
  virtual std::optional<std::uint32_t> crc(std::int64_t) const { return std::nullopt; }
};

// Reads rows of any source. A source that has only slices is read by whole slices, and the reader holds one.
class RowReader {
 public:
  explicit RowReader(SliceSource& volume);

  // Reads rows as RowSource::read_rows does.
  void read(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out);

 private:
  SliceSource& volume_;
  RowSource* rows_;  // the same, if it has rows
  std::vector<std::byte> slice_;
  std::int64_t held_ = -1;  // the slice that is held
};

// The bytes that a source holds (BufferedSource::held_bytes), and those that a RowReader adds.
std::uint64_t held_by_rows(const SliceSource& volume);

// The bytes that a source holds (BufferedSource::held_bytes).
std::uint64_t held_by_slices(const SliceSource& volume);

// The samples of the file (BufferedSource::in_file).
Region samples_in_file(const SliceSource& volume, const Region& samples);

// The name of a sample by its place in the file: "sample 3,0,1", or "samples 2:4,0:2,0:2" of a volume made smaller.
std::string sample_in_file(const SliceSource& volume, const std::array<std::int64_t, 3>& sample);

// Refuses a volume that has to be read from its beginning, for blocks. Throws BadInput.
void require_skipping(const SliceSource& volume);

// The value of every sample (RowSource::constant); nothing for sources without rows.
std::optional<SampleBytes> constant_sample(const SliceSource& volume);

// The range and the CRC-32 of a slice (RowSource::range, crc); nothing for sources without rows.
const SampleRange* known_range(const SliceSource& volume, std::int64_t k);
std::optional<std::uint32_t> known_crc(const SliceSource& volume, std::int64_t k);

}  // namespace isoweave
