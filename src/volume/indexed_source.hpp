// A volume of which only the parts near surfaces are read, as its index tells.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "volume/crossed_bricks.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

// The amounts that were not read.
struct LeftOut {
  std::uint64_t chunks = 0, chunks_left_out = 0;
  std::uint64_t bytes_left_out = 0;  // of samples
};

// Hands out samples of the volume near surfaces, and elsewhere samples on the same side of them: the surfaces are the
// same. Chunks that no needed sample lies in are left out where a format has chunks, else rows where skipping costs
// next to nothing. From other sources everything is read.
class IndexedSource final : public RowSource {
 public:
  // The volume must outlive this source. Throws std::invalid_argument for the index of a volume of another size or
  // type.
  IndexedSource(SliceSource& volume, std::shared_ptr<const VolumeIndex> index,
                std::span<const IndexedSurface> surfaces);
  ~IndexedSource() override;

  const VolumeInfo& info() const override { return volume_.info(); }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  bool skips() const override { return volume_.skips(); }
  std::span<const std::byte> held() const override { return volume_.held(); }
  std::uint64_t held_bytes() const override;
  Region in_file(const Region& samples) const override { return samples_in_file(volume_, samples); }
  std::optional<SampleBytes> constant() const override { return constant_sample(volume_); }
  const SampleRange* range(std::int64_t k) const override;
  std::optional<std::uint32_t> crc(std::int64_t k) const override;

  LeftOut left_out() const;

 private:
  void fill(std::int64_t k, std::int64_t first, std::int64_t count, std::byte* out);
  void fill_run(const UnneededRun& run, std::byte* row) const;
  bool is_unneeded(std::int64_t j, std::int64_t k);
  void read_needed_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::byte* out);

  SliceSource& volume_;
  RowSource* const rows_;  // the same, if it has rows
  RowReader reader_;
  Gaps* const gaps_;  // of it, if it has chunks
  const std::shared_ptr<const VolumeIndex> index_;
  CrossedBricks bricks_;
  std::size_t sample_bytes_;
  std::size_t row_bytes_;
  std::uint64_t rows_left_out_ = 0;
};

}  // namespace isoweave
