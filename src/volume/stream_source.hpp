// The slice source of every file format: slices cut from a forward-only stream of bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "files/byte_stream.hpp"
#include "files/length_units.hpp"
#include "isoweave/volume.hpp"
#include "volume/band_stream.hpp"
#include "volume/row_source.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {

// The result of a format's reader: the facts of the header, and the samples as they are stored.
struct OpenedVolume {
  VolumeInfo info;
  std::unique_ptr<ByteStream> samples;
  bool swap_bytes = false;    // the stored byte order is not the machine's
  std::string unit_conflict;  // units of the axes that cannot be made one: without --spacing no volume
  FilePtr input;  // what the user named, open as long as the volume: what came out of a pipe is kept with it
  std::uint64_t held_bytes = 0;                   // by `samples`, at most: what must be decoded as a whole
  std::shared_ptr<Gaps> gaps{};                   // of `samples`, where they are chunks
  BandStream* bands = nullptr;                    // in `samples`, where they can hold a box alone
  std::optional<SampleBytes> constant{};          // as stored: every sample is this one, and none is read
  std::optional<std::int64_t> place_in_series{};  // of a file of one slice, which says its place among the others
};

class StreamSource final : public RowSource {
 public:
  explicit StreamSource(OpenedVolume volume);

  const VolumeInfo& info() const override { return volume_.info; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) override;
  void read_part_of_row(std::int64_t k, std::int64_t j, std::int64_t i, std::span<std::byte> out) override;
  bool skips() const override { return volume_.samples->skips(); }
  bool reads_parts_of_rows() const override { return skips() && volume_.gaps == nullptr && volume_.held_bytes == 0; }
  bool reads_boxes() const override { return reads_parts_of_rows() || volume_.bands != nullptr; }
  bool narrow(const Region& box) override;
  std::uint64_t held_bytes() const override { return volume_.held_bytes; }
  std::optional<SampleBytes> constant() const override;
  Gaps* gaps() override { return volume_.gaps.get(); }

 private:
  void read_from(std::uint64_t place, std::span<std::byte> wanted);

  OpenedVolume volume_;
  std::uint64_t place_ = 0;  // the byte of the samples that the stream stands at
};

// Takes unit and notes over. A conflict becomes what open_volume refuses unless the caller gives the spacing.
void take_unit(OpenedVolume& volume, const CommonUnit& unit);

// Reverses the bytes of every sample of `bytes_each` bytes.
void swap_sample_bytes(std::span<std::byte> samples, std::size_t bytes_each);

// Throws BadInput unless a stored stream of `stored` bytes can hold `bytes` at all, given that one stored byte
// decodes to at most `largest_ratio`. A header's claim is believed only after this.
void check_plausible(std::string_view path, std::uint64_t bytes, std::uint64_t stored, std::uint64_t largest_ratio);

// The `bytes` of samples that lie from byte `begin` of a file on. Throws BadInput when the file cannot hold them.
std::unique_ptr<ByteStream> samples_in(const FilePtr& file, std::uint64_t begin, std::uint64_t bytes);

// Deflate cannot do better than 258 bytes from two bits.
inline constexpr std::uint64_t kDeflateRatio = 1032;

}  // namespace isoweave
