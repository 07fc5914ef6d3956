// Streams of samples that are stored in blocks several slices deep. A band of slices, as deep as a block, is held at a
// time, so that every block is decoded once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "files/byte_stream.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

// The part of each slice that is read: rows, and bytes of each.
struct BandWindow {
  std::uint64_t row_bytes = 0;  // of a whole row
  std::uint64_t first_row = 0, rows = 0;
  std::uint64_t first_byte = 0, bytes = 0;

  std::uint64_t slice_bytes() const { return rows * bytes; }
};

class BandStream : public ByteStream {
 public:
  // Bytes of a row within the window, where there is one.
  std::size_t read(std::span<std::byte> out) override;
  std::uint64_t skip(std::uint64_t count) override;
  bool skips() const override { return true; }

  // The most bytes of a band that are held.
  std::uint64_t held_bytes() const { return static_cast<std::uint64_t>(depth_) * kept_slice(); }

  // Whether bands can hold a box of samples alone.
  virtual bool narrows() const { return false; }

  // Says that no samples beside a box will be read, before any is.
  virtual void narrow(const Region&) {}

 protected:
  // `depth`: slices of a band, at least 1; bands begin at its multiples.
  BandStream(std::int64_t slices, std::size_t slice_bytes, std::int64_t depth);

  // Keeps the window of each slice alone.
  void keep(const BandWindow& window) { window_ = window; }

  // Fills a band, or the last piece of one, with slices [first, first + count), or with their windows.
  virtual void fill(std::int64_t first, std::int64_t count, std::span<std::byte> band) = 0;

 private:
  std::uint64_t band_bytes(std::int64_t band) const;
  std::uint64_t kept_slice() const { return window_ ? window_->slice_bytes() : slice_bytes_; }
  void fill_band(std::span<std::byte> band);
  void fill_buffer();
  std::size_t read_in_window(std::span<std::byte> out);
  void advance(std::uint64_t bytes);

  std::int64_t slices_;
  std::size_t slice_bytes_;
  std::int64_t depth_;
  std::optional<BandWindow> window_;
  std::int64_t band_ = 0;   // the band that is read from
  std::uint64_t used_ = 0;  // bytes of it
  bool filled_ = false;     // whether buffer_ holds it
  std::vector<std::byte> buffer_;
};

// Copies samples between two layouts. Along axis a there are size[a], from_step[a] and to_step[a] samples apart.
struct BlockCopy {
  std::array<std::int64_t, 3> size{1, 1, 1};
  std::array<std::int64_t, 3> from_step{0, 0, 0};
  std::array<std::int64_t, 3> to_step{0, 0, 0};
};
void copy_block(const std::byte* from, std::byte* to, const BlockCopy& copy, std::size_t sample_bytes);

}  // namespace isoweave
