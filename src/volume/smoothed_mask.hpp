// A mask turned into a field that is smooth where the mask allows it, as a volume of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isoweave/volume.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"
#include "volume/samples.hpp"

namespace isoweave {

struct SmoothedMaskOptions {
  double iso = 0.5;   // of stored samples
  bool above = true;  // inside is sample >= iso; else sample <= iso. NaN is outside
  int passes = kUsualSmoothing;
  bool measure = false;  // find the range of the stored samples of each slice
};

// See smooth_mask. The passes follow each other like the stages of a pipeline: each holds the three slices of its
// input, and of its blurred input, that its next slice needs. A mark tells the rows around which all samples are on one
// side. Such rows take no time and touch no memory, so that small objects in large volumes cost little.
class SmoothedMask final : public SliceSource {
 public:
  // The source and the executor must outlive this source.
  SmoothedMask(SliceSource& source, const SmoothedMaskOptions& options, const Executor& executor);

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return source_.skips(); }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override;

  // The range of the stored samples of slice k, once that slice has come out. Nothing if ranges are not measured.
  const SampleRange* range(std::int64_t k) const {
    return ranges_.empty() ? nullptr : &ranges_[static_cast<std::size_t>(k)];
  }

  // Slices on either side that a sample depends on, and as many samples along the other axes.
  std::int64_t reach() const { return reach(options_.passes); }
  static std::int64_t reach(int passes) { return kReach * passes; }

  // The most bytes that a smoothed mask holds, and the description that it will have.
  static std::uint64_t memory(const VolumeInfo& volume, int passes);
  static VolumeInfo info_of(const VolumeInfo& volume);

 private:
  static constexpr std::int64_t kReach = 2;  // of one pass

  // A row that is marked +1 or -1 holds that everywhere and is not stored.
  struct Slice {
    Array<float> samples;
    std::vector<std::int8_t> marks;
  };

  // The last three slices of a volume, of which `end` have come.
  struct Ring {
    std::array<Slice, 3> slices;
    std::int64_t end = 0;

    Slice& operator[](std::int64_t k) { return slices[static_cast<std::size_t>(k % 3)]; }
  };

  struct Pass {
    Ring field, blurred;
    std::int64_t next = 0;  // slice that comes out
  };

  // Nine rows around one, all equal to `mark` where that is not 0.
  struct Rows {
    std::array<const float*, 9> samples;
    std::int8_t mark;
  };

  void start_at(std::int64_t first);
  void next_slice(std::size_t passes, Slice& out);
  void read_mask(Slice& out);
  template <class T>
  void read_row(std::int64_t row, Slice& out) const;
  void blur_next(std::size_t n);
  void clamp_next(Pass& pass, Slice& out);
  const float* row(const Slice& slice, std::int64_t j) const;
  Rows rows_around(Ring& ring, std::int64_t k, std::int64_t j) const;
  template <class Finisher>
  void blur(Ring& ring, std::int64_t k, Slice& out, const Finisher& finisher);

  SliceSource& source_;
  SmoothedMaskOptions options_;
  const Executor& executor_;
  VolumeInfo info_;
  std::array<std::vector<float>, 2> constant_rows_;  // -1, 1
  std::vector<std::byte> stored_;                    // a slice of the source
  std::int64_t mask_end_ = 0;                        // slices of the source that have been read
  std::vector<Pass> passes_;
  Slice last_;             // that came out
  std::int64_t next_ = 0;  // that comes out next
  std::vector<SampleRange> ranges_;
};

}  // namespace isoweave
