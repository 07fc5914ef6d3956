// The parts of a volume that a forecast looks at: some slices of it, and a tile of those that is small enough to be
// simplified.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "extract/cube_rules.hpp"
#include "isoweave/volume.hpp"
#include "parallel/array.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

// The samples inside on the four sides of a slice, of which `slice` has some rows. Two sides of them are cuts, so the
// two others stand for all four.
double inside_on_sides(std::span<const std::byte> slice, const VolumeInfo& info, const IsoRule& rule,
                       std::int64_t rows);

// Part of a slice, in samples.
struct Rectangle {
  std::array<std::int64_t, 2> from{}, size{};
};

// The places of triangles on a slice: counts in a grid of bins.
class TriangleMap {
 public:
  explicit TriangleMap(const std::array<std::int64_t, 3>& dims) : dims_(dims), counts_(kBins * kBins) {}

  // A triangle at a place of the slice, in samples.
  void add(double i, double j) { ++counts_[bin(j, 1) * kBins + bin(i, 0)]; }

  // So many square parts of a slice (as far as samples are square), each with at least a share of the triangles. They
  // lie where the triangles do: many parts where there are many of them. Together they are no more than `most` of the
  // slice; all of it where that is allowed and little more than the parts. One part around the middle while no triangle
  // is known.
  std::vector<Rectangle> parts(std::size_t number, double share, double most) const;

 private:
  static constexpr std::size_t kBins = 32;

  std::size_t bin(double place, std::size_t axis) const;
  std::uint64_t count(std::size_t i, std::size_t j, std::size_t side) const;
  std::array<std::size_t, 2> bin_at(std::uint64_t rank) const;
  Rectangle part_around(const std::array<std::size_t, 2>& bin, double triangles, std::size_t most_side) const;
  Rectangle rectangle(std::size_t i, std::size_t j, std::size_t side) const;

  std::array<std::int64_t, 3> dims_;
  std::vector<std::uint64_t> counts_;
};

// Samples of a part of some slices, in memory.
class Tile final : public SliceSource {
 public:
  // With room for `slices` of them; the geometry is the volume's.
  Tile(const VolumeInfo& volume, const Rectangle& part, std::int64_t slices);

  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;

  // Takes slice n from a whole one of the volume.
  void take(std::int64_t n, std::span<const std::byte> slice);

  // A part of the tile: another part of the slices, moved into the tile.
  Tile cut(const Rectangle& part) const;

 private:
  std::size_t offset(std::int64_t n) const { return static_cast<std::size_t>(n) * info_.slice_bytes(); }

  VolumeInfo info_;
  Rectangle part_;
  std::int64_t whole_row_;  // samples
  Array<std::byte> samples_;
};

// A band: some rows of slices.
struct RowBand {
  std::int64_t from = 0, count = 0;
};

// A band of rows of some slices of a volume as a volume of its own. Every slice of it that is read is shown to `look`.
class Section final : public SliceSource {
 public:
  using Look = std::function<void(std::int64_t n, std::span<const std::byte> slice)>;

  // `rows` reads the volume that `info` is of.
  Section(RowReader& rows, const VolumeInfo& info, std::int64_t first, std::int64_t slices, RowBand band, Look look);

  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;

 private:
  RowReader& rows_;
  std::int64_t first_;
  RowBand band_;
  VolumeInfo info_;
  Look look_;
};

}  // namespace isoweave
