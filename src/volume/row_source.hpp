// Sources that can hand out rows of slices, as a slice may be larger than the memory there is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

// One sample as it is in memory; those of fewer bytes leave the rest alone.
using SampleBytes = std::array<std::byte, 8>;

class RowSource : public SliceSource {
 public:
  // Reads `count` rows of slice k, from row `first` on. As read() does for slices, it goes forward only: once a row of
  // a slice has been read, the slices before it are behind.
  virtual void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) = 0;

  // The most bytes that reading holds beside the memory it is given: a band of slices, a strip, a decoded slice.
  virtual std::uint64_t held_bytes() const { return 0; }

  // The value of every sample, where it is known without reading any.
  virtual std::optional<SampleBytes> constant() const { return std::nullopt; }
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

// The bytes that a source holds (RowSource::held_bytes), and those that a RowReader adds.
std::uint64_t held_by_rows(const SliceSource& volume);

// The bytes that a source holds (RowSource::held_bytes); 0 for sources without rows.
std::uint64_t held_by_slices(const SliceSource& volume);

// The value of every sample (RowSource::constant); nothing for sources without rows.
std::optional<SampleBytes> constant_sample(const SliceSource& volume);

}  // namespace isoweave
