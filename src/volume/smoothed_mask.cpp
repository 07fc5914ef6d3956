#include "volume/smoothed_mask.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "parallel/size.hpp"
#include "volume/row_source.hpp"
#include "volume/threshold.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

constexpr float kNearest = 1.0F / 256;  // the nearest that a sample may come to 0: its sign is its side
constexpr std::int64_t kRowsPerBlock = 8;

// Weights 1-2-1 along two axes.
void add_rows(const std::array<const float*, 9>& rows, std::size_t size, float* sums) {
  const auto along_z = [&](std::size_t y, std::size_t i) { return (rows[y][i] + rows[6 + y][i]) + 2 * rows[3 + y][i]; };
  for (std::size_t i = 0; i < size; ++i) sums[i] = (along_z(0, i) + along_z(2, i)) + 2 * along_z(1, i);
}

// Adds the weights along the third axis. finish(i, mean) takes the weighted mean of the 27 samples around sample i.
template <class Finish>
void add_along(const float* sums, std::size_t size, const Finish& finish) {
  constexpr float kScale = 1.0F / 64;
  const auto mean = [&](std::size_t left, std::size_t i, std::size_t right) {
    return ((sums[left] + sums[right]) + 2 * sums[i]) * kScale;
  };
  finish(0, mean(0, 0, std::min<std::size_t>(1, size - 1)));
  for (std::size_t i = 1; i + 1 < size; ++i) finish(i, mean(i - 1, i, i + 1));
  if (size > 1) finish(size - 1, mean(size - 2, size - 1, size - 1));
}

// A smoothed mask that owns its source.
class OwningSmoothedMask final : public BufferedSource {
 public:
  OwningSmoothedMask(std::unique_ptr<SliceSource> source, const SmoothedMaskOptions& options, int threads)
      : source_(std::move(source)),
        executor_(threads),
        field_(*source_, options, executor_),
        field_bytes_(SmoothedMask::memory(source_->info(), options.passes)) {}

  const VolumeInfo& info() const override { return field_.info(); }
  bool skips() const override { return field_.skips(); }
  std::uint64_t held_bytes() const override { return held_by_slices(*source_) + field_bytes_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    field_.read(first, count, out);
  }

 private:
  std::unique_ptr<SliceSource> source_;
  Executor executor_;
  SmoothedMask field_;
  std::uint64_t field_bytes_;
};

}  // namespace

SmoothedMask::SmoothedMask(SliceSource& source, const SmoothedMaskOptions& options, const Executor& executor)
    : source_(source), options_(options), executor_(executor), info_(info_of(source.info())) {
  if (options.passes < 1 || options.passes > kMostSmoothing) {
    throw std::invalid_argument("smooth: expected 1 to " + std::to_string(kMostSmoothing) + " passes, found " +
                                std::to_string(options.passes));
  }
  passes_.resize(static_cast<std::size_t>(options.passes));
  if (options.measure) ranges_.resize(to_size(info_.dims[2]));
}

VolumeInfo SmoothedMask::info_of(const VolumeInfo& volume) {
  VolumeInfo info = volume;
  info.type = SampleType::kFloat32;
  info.slope = 1;
  info.intercept = 0;
  return info;
}

std::uint64_t SmoothedMask::memory(const VolumeInfo& volume, int passes) {
  const auto samples = static_cast<std::uint64_t>(volume.slice_samples());
  return volume.slice_bytes() + (6 * static_cast<std::uint64_t>(passes) + 1) * sizeof(float) * samples;
}

void SmoothedMask::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  check_slice_range(info_, next_, first, count, out.size());
  if (count == 0) return;
  if (stored_.empty()) start_at(first);
  if (first - reach() > mask_end_) start_at(first);
  const auto nx = static_cast<std::size_t>(info_.dims[0]);
  auto* to = reinterpret_cast<float*>(out.data());
  while (next_ < first + count) {
    next_slice(passes_.size(), last_);
    if (next_++ < first) continue;
    for (std::int64_t j = 0; j < info_.dims[1]; ++j, to += nx) std::copy_n(row(last_, j), nx, to);
  }
}

// Makes slice `first`, or one before it, the next one that comes out. Slices farther below than the reach of all passes
// need not be read.
void SmoothedMask::start_at(std::int64_t first) {
  const std::size_t nx = to_size(info_.dims[0]);
  if (stored_.empty()) {
    stored_.resize(source_.info().slice_bytes());
    constant_rows_ = {std::vector<float>(nx, -1.0F), std::vector<float>(nx, 1.0F)};
    const auto make_room = [&](Slice& slice) {
      slice.samples.resize(to_size(info_.slice_samples()));
      slice.marks.resize(to_size(info_.dims[1]));
    };
    make_room(last_);
    for (Pass& pass : passes_) {
      for (Ring* ring : {&pass.field, &pass.blurred}) std::ranges::for_each(ring->slices, make_room);
    }
  }
  mask_end_ = std::max<std::int64_t>(first - reach(), 0);
  std::int64_t begin = mask_end_;
  for (Pass& pass : passes_) {
    pass.field.end = begin;
    pass.blurred.end = begin > 0 ? begin + 1 : 0;
    pass.next = begin > 0 ? begin + kReach : 0;
    begin = pass.next;
  }
  next_ = begin;
}

// Makes the next slice of the field after so many passes.
void SmoothedMask::next_slice(std::size_t passes, Slice& out) {
  if (passes == 0) return read_mask(out);
  Pass& pass = passes_[passes - 1];
  const std::int64_t end = std::min(pass.next + 2, info_.dims[2]);
  while (pass.blurred.end < end) blur_next(passes);
  clamp_next(pass, out);
}

void SmoothedMask::read_mask(Slice& out) {
  const VolumeInfo& info = source_.info();
  source_.read(mask_end_, 1, stored_);
  if (options_.measure) {
    ranges_[static_cast<std::size_t>(mask_end_)] = sample_range(stored_.data(), info.type, info.slice_samples());
  }
  ++mask_end_;
  executor_.for_each(info.dims[1], kRowsPerBlock,
                     [&](std::int64_t j) { visit_sample_type(info.type, [&]<class T>() { read_row<T>(j, out); }); });
}

template <class T>
void SmoothedMask::read_row(std::int64_t j, Slice& out) const {
  const std::int64_t nx = info_.dims[0];
  const T* const samples = reinterpret_cast<const T*>(stored_.data()) + j * nx;
  float* const to = out.samples.data() + j * nx;
  const auto is_inside = [threshold = threshold_for<T>(options_.iso, options_.above),
                          above = options_.above](T sample) {
    if (!threshold.reachable) return false;
    return above ? sample >= threshold.value : sample <= threshold.value;
  };
  std::int64_t inside = 0;
  for (std::int64_t i = 0; i < nx; ++i) inside += is_inside(samples[i]) ? 1 : 0;
  std::int8_t& mark = out.marks[static_cast<std::size_t>(j)];
  mark = 0;
  if (inside == 0) mark = -1;
  if (inside == nx) mark = 1;
  if (mark != 0) return;
  for (std::int64_t i = 0; i < nx; ++i) to[i] = is_inside(samples[i]) ? 1.0F : -1.0F;
}

// Makes one more slice of pass n's blurred field.
void SmoothedMask::blur_next(std::size_t n) {
  Pass& pass = passes_[n - 1];
  const std::int64_t k = pass.blurred.end;
  const std::int64_t end = std::min(k + 2, info_.dims[2]);
  while (pass.field.end < end) {
    next_slice(n - 1, pass.field[pass.field.end]);
    ++pass.field.end;
  }
  Slice& out = pass.blurred[k];
  blur(pass.field, k, out, [](std::int64_t) { return [](std::size_t, float mean) { return mean; }; });
  ++pass.blurred.end;
}

// Makes a slice of a pass: twice the blurred field less the field blurred twice, kept on its side of 0.
void SmoothedMask::clamp_next(Pass& pass, Slice& out) {
  const std::int64_t k = pass.next++;
  const Slice& field = pass.field[k];
  const Slice& blurred = pass.blurred[k];
  blur(pass.blurred, k, out, [&](std::int64_t j) {
    return [once = row(blurred, j), side = row(field, j)](std::size_t i, float twice) {
      const float value = 2 * once[i] - twice;
      return side[i] > 0 ? std::max(value, kNearest) : std::min(value, -kNearest);
    };
  });
}

const float* SmoothedMask::row(const Slice& slice, std::int64_t j) const {
  const std::int8_t mark = slice.marks[static_cast<std::size_t>(j)];
  return mark == 0 ? slice.samples.data() + j * info_.dims[0] : constant_rows_[mark > 0 ? 1 : 0].data();
}

// Rows beyond the border are those at the border: the surface meets it at a right angle.
SmoothedMask::Rows SmoothedMask::rows_around(Ring& ring, std::int64_t k, std::int64_t j) const {
  Rows rows{};
  for (std::int64_t n = 0; n < 9; ++n) {
    const Slice& slice = ring[std::clamp<std::int64_t>(k + n / 3 - 1, 0, info_.dims[2] - 1)];
    const std::int64_t at = std::clamp<std::int64_t>(j + n % 3 - 1, 0, info_.dims[1] - 1);
    const std::int8_t mark = slice.marks[static_cast<std::size_t>(at)];
    rows.samples[static_cast<std::size_t>(n)] = row(slice, at);
    rows.mark = n == 0 || mark == rows.mark ? mark : std::int8_t{0};
  }
  return rows;
}

// Takes weighted means of the 3 x 3 x 3 samples around each sample of slice k, with weights 1-2-1 along each axis.
// finisher(j)(i, mean) turns a mean into what is stored.
template <class Finisher>
void SmoothedMask::blur(Ring& ring, std::int64_t k, Slice& out, const Finisher& finisher) {
  const auto nx = static_cast<std::size_t>(info_.dims[0]);
  executor_.for_blocks(info_.dims[1], kRowsPerBlock, [&](std::int64_t begin, std::int64_t end) {
    std::vector<float> sums(nx);
    for (std::int64_t j = begin; j < end; ++j) {
      const Rows rows = rows_around(ring, k, j);
      out.marks[static_cast<std::size_t>(j)] = rows.mark;
      if (rows.mark != 0) continue;
      add_rows(rows.samples, nx, sums.data());
      float* const to = out.samples.data() + static_cast<std::size_t>(j) * nx;
      const auto finish = finisher(j);
      add_along(sums.data(), nx, [&](std::size_t i, float mean) { to[i] = finish(i, mean); });
    }
  });
}

std::unique_ptr<SliceSource> smooth_mask(std::unique_ptr<SliceSource> volume, const SmoothOptions& options,
                                         int threads) {
  if (!std::isfinite(options.iso)) throw std::invalid_argument("iso: expected a finite number");
  const VolumeInfo& info = volume->info();
  SmoothedMaskOptions stored;
  stored.iso = (options.iso - info.intercept) / info.slope;
  stored.above = options.inside_above == (info.slope > 0);
  stored.passes = options.passes;
  return std::make_unique<OwningSmoothedMask>(std::move(volume), stored, threads);
}

}  // namespace isoweave
