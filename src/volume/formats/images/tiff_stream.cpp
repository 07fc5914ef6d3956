#include "volume/formats/images/tiff_stream.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "parallel/size.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

TiffPageStream::TiffPageStream(TiffPtr tiff, const TiffPageKind& kind, std::vector<std::uint64_t> pages,
                               std::shared_ptr<Gaps> gaps)
    : gaps_(std::move(gaps)), tiff_(std::move(tiff)), kind_(kind), pages_(std::move(pages)) {
  sample_bytes_ = sample_bytes(kind.type.type);
  row_bytes_ = to_size(kind.width, sample_bytes_);
}

std::size_t TiffPageStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && at_band()) {
    if (!decoded_) decode();
    const std::size_t step = std::min(out.size() - done, band_bytes() - used_);
    std::memcpy(out.data() + done, band_.data() + used_, step);
    done += step;
    advance(step);
  }
  return done;
}

std::uint64_t TiffPageStream::skip(std::uint64_t count) {
  std::uint64_t done = 0;
  while (done < count && at_band()) {
    const std::uint64_t step = std::min<std::uint64_t>(count - done, band_bytes() - used_);
    // A band that is skipped whole need not be decoded.
    if (!decoded_ && step < band_bytes()) decode();
    done += step;
    advance(static_cast<std::size_t>(step));
  }
  return done;
}

std::uint64_t TiffPageStream::held_bytes() {
  if (!at_band()) return 0;
  const std::uint64_t stored = TIFFGetStrileByteCount(tiff_->handle(), 0);
  const auto tile = static_cast<std::uint64_t>(static_cast<double>(tile_width_) * static_cast<double>(tile_rows_)) *
                    (tiled_ ? sample_bytes_ : 0);
  return band_bytes() + tile + std::min(stored, tiff_->file()->size());
}

// Whether there is a band to read from; enters the next page where one has ended.
bool TiffPageStream::at_band() {
  if (page_ >= pages_.size()) return false;
  if (!entered_) enter_page();
  return true;
}

void TiffPageStream::enter_page() {
  TIFF* const handle = tiff_->handle();
  if (TIFFSetSubDirectory(handle, pages_[page_]) == 0) tiff_->refuse("a readable TIFF directory");
  tiled_ = TIFFIsTiled(handle) != 0;
  tile_width_ = tiled_ ? tiff_->field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : 0;
  const std::uint32_t rows = tiled_ ? tiff_->field<std::uint32_t>(TIFFTAG_TILELENGTH, 0)
                                    : tiff_->field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 0);
  if (rows == 0 || (tiled_ && tile_width_ == 0)) {
    bad_input(tiff_->file()->path(), "strips or tiles of at least one row", "none");
  }
  tile_rows_ = rows;
  band_rows_ = std::min<std::int64_t>(rows, kind_.height);
  ratio_ = largest_tiff_ratio(tiff_->field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE));
  entered_ = true;
  row_ = 0;
}

std::size_t TiffPageStream::band_bytes() const {
  return to_size(std::min(band_rows_, kind_.height - row_), row_bytes_);
}

void TiffPageStream::advance(std::size_t bytes) {
  used_ += bytes;
  if (used_ < band_bytes()) return;
  used_ = 0;
  decoded_ = false;
  row_ += band_rows_;
  if (row_ < kind_.height) return;
  entered_ = false;
  ++page_;
}

void TiffPageStream::decode() {
  band_.resize(band_bytes());
  if (tiled_) {
    decode_tiles();
  } else if (!leaves_out(0, kind_.width)) {
    decode_strip();
  }
  decoded_ = true;
}

bool TiffPageStream::leaves_out(std::int64_t left, std::int64_t right) {
  const auto k = static_cast<std::int64_t>(page_);
  return gaps_->leaves_out({{left, row_, k}, {right, std::min(row_ + band_rows_, kind_.height), k + 1}});
}

std::string TiffPageStream::place(std::uint32_t strile) const {
  return (tiled_ ? "tile " : "strip ") + std::to_string(strile) + " of page " + std::to_string(page_);
}

void TiffPageStream::check_decoded(std::int64_t got, std::size_t wanted, std::uint32_t strile) const {
  if (got == static_cast<std::int64_t>(wanted)) return;
  if (got < 0) tiff_->refuse("a readable " + place(strile));
  bad_input(tiff_->file()->path(), std::to_string(wanted) + " bytes in " + place(strile), std::to_string(got));
}

void TiffPageStream::decode_strip() {
  const auto strip = static_cast<std::uint32_t>(row_ / band_rows_);
  check_plausible(tiff_->file()->path(), band_.size(), TIFFGetStrileByteCount(tiff_->handle(), strip), ratio_);
  const auto got = TIFFReadEncodedStrip(tiff_->handle(), strip, band_.data(), static_cast<tmsize_t>(band_.size()));
  check_decoded(got, band_.size(), strip);
}

// A row of tiles, of which the last may hang over the edge.
void TiffPageStream::decode_tiles() {
  for (std::int64_t left = 0; left < kind_.width; left += tile_width_) {
    if (leaves_out(left, std::min(left + tile_width_, kind_.width))) continue;
    const std::uint32_t tile =
        TIFFComputeTile(tiff_->handle(), static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(row_), 0, 0);
    decode_tile(tile);
    const auto columns = static_cast<std::size_t>(std::min<std::int64_t>(tile_width_, kind_.width - left));
    const std::size_t tile_row = static_cast<std::size_t>(tile_width_) * sample_bytes_;
    for (std::size_t row = 0; row * row_bytes_ < band_.size(); ++row) {
      std::memcpy(band_.data() + row * row_bytes_ + static_cast<std::size_t>(left) * sample_bytes_,
                  tile_.data() + row * tile_row, columns * sample_bytes_);
    }
  }
}

void TiffPageStream::decode_tile(std::uint32_t tile) {
  std::uint64_t bytes = 0;
  const std::uint64_t samples = static_cast<std::uint64_t>(tile_width_) * static_cast<std::uint64_t>(tile_rows_);
  if (__builtin_mul_overflow(samples, sample_bytes_, &bytes)) {
    bad_input(tiff_->file()->path(), "tiles of fewer than 2^63 bytes", "larger ones");
  }
  check_plausible(tiff_->file()->path(), bytes, TIFFGetStrileByteCount(tiff_->handle(), tile), ratio_);
  tile_.resize(to_size(bytes));
  const auto got = TIFFReadEncodedTile(tiff_->handle(), tile, tile_.data(), static_cast<tmsize_t>(tile_.size()));
  check_decoded(got, tile_.size(), tile);
}

}  // namespace isoweave
