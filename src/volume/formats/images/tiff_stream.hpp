// The samples of TIFF pages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "files/byte_stream.hpp"
#include "volume/formats/images/tiff_file.hpp"
#include "volume/formats/images/tiff_pages.hpp"
#include "volume/gaps.hpp"

namespace isoweave {

// The samples of a list of pages, decoded band by band (a strip or a row of tiles), in the machine's byte order.
class TiffPageStream final : public ByteStream {
 public:
  // `pages` are the slices of the volume that `gaps` speaks of.
  TiffPageStream(TiffPtr tiff, const TiffPageKind& kind, std::vector<std::uint64_t> pages, std::shared_ptr<Gaps> gaps);

  std::size_t read(std::span<std::byte> out) override;
  std::uint64_t skip(std::uint64_t count) override;

  // The bytes that decoding a band of the first page takes: its rows, a tile, and the stored bytes of either.
  std::uint64_t held_bytes();

 private:
  bool at_band();
  void enter_page();
  std::size_t band_bytes() const;
  void advance(std::size_t bytes);
  void decode();
  void decode_strip();
  void decode_tiles();
  void decode_tile(std::uint32_t tile);
  std::string place(std::uint32_t strile) const;
  void check_decoded(std::int64_t got, std::size_t wanted, std::uint32_t strile) const;

  // Whether the columns [left, right) of the band are not needed.
  bool leaves_out(std::int64_t left, std::int64_t right);

  std::shared_ptr<Gaps> gaps_;
  TiffPtr tiff_;
  TiffPageKind kind_;
  std::vector<std::uint64_t> pages_;
  std::size_t sample_bytes_ = 1;
  std::size_t row_bytes_ = 0;

  std::size_t page_ = 0;
  bool entered_ = false;
  bool tiled_ = false;
  std::int64_t tile_width_ = 0;
  std::int64_t tile_rows_ = 0;
  std::int64_t band_rows_ = 0;  // of the page's strips or tiles, no more than it has
  std::uint64_t ratio_ = 1;

  std::int64_t row_ = 0;  // first row of the band
  bool decoded_ = false;
  std::size_t used_ = 0;  // bytes of the band
  std::vector<std::byte> band_;
  std::vector<std::byte> tile_;
};

}  // namespace isoweave
