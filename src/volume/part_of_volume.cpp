// A box of a volume, and a volume made smaller.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "isoweave/volume.hpp"
#include "parallel/size.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"
#include "volume/smaller.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

class SamplesOfBox final : public NeededSamples {
 public:
  explicit SamplesOfBox(const Region& box) : box_(box) {}

  bool any_in(const Region& box) const override {
    bool meets = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      meets = meets && box.first[axis] < box_.end[axis] && box.end[axis] > box_.first[axis];
    }
    return meets;
  }

 private:
  Region box_;
};

class CroppedVolume final : public RowSource {
 public:
  CroppedVolume(std::unique_ptr<SliceSource> whole, const Region& region)
      : whole_(std::move(whole)), reader_(*whole_), info_(whole_->info()), region_(region), needed_(region) {
    std::array<double, 3> first{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (region.first[axis] < 0 || region.first[axis] >= region.end[axis] || region.end[axis] > info_.dims[axis]) {
        throw std::invalid_argument(info_.path + ": expected a region within 0:" + std::to_string(info_.dims[axis]) +
                                    " on axis " + std::to_string(axis) + ", found " +
                                    std::to_string(region.first[axis]) + ":" + std::to_string(region.end[axis]));
      }
      info_.dims[axis] = region.end[axis] - region.first[axis];
      first[axis] = static_cast<double>(region.first[axis]);
    }
    move_origin(info_.geometry, first);
    auto* const rows = dynamic_cast<RowSource*>(whole_.get());
    if (rows == nullptr) return;
    if (rows->gaps() != nullptr) rows->gaps()->needed = &needed_;
    narrowed_ = rows->narrow(region);
    if (narrowed_ || rows->reads_parts_of_rows()) parts_ = rows;
  }

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return whole_->skips(); }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    check_slice_range(info_, 0, first, count, out.size());
    for (std::int64_t k = first; k < first + count; ++k) {
      read_rows(k, 0, info_.dims[1], out.subspan(static_cast<std::size_t>(k - first) * info_.slice_bytes()));
    }
  }

  void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    whole_->held().empty() ? reads_parts() ? read_parts(k, first, count, out) : read_whole_rows(k, first, count, out)
                           : copy_rows(k, first, count, out);
  }

  bool reads_parts_of_rows() const override { return parts_ != nullptr && !narrowed_; }
  bool reads_boxes() const override { return parts_ != nullptr; }

  bool narrow(const Region& box) override { return narrowed_ && parts_->narrow(in_whole(box)); }

  void read_part_of_row(std::int64_t k, std::int64_t j, std::int64_t i, std::span<std::byte> out) override {
    parts_->read_part_of_row(region_.first[2] + k, region_.first[1] + j, region_.first[0] + i, out);
  }

  std::uint64_t held_bytes() const override { return held_by_rows(*whole_); }
  Region in_file(const Region& samples) const override { return samples_in_file(*whole_, in_whole(samples)); }
  std::optional<SampleBytes> constant() const override { return constant_sample(*whole_); }

 private:
  static constexpr std::size_t kBlockBytes = 1 << 20;

  std::size_t sample() const { return sample_bytes(info_.type); }
  std::size_t row() const { return to_size(info_.dims[0], sample()); }
  std::size_t whole_row() const { return to_size(whole_->info().dims[0], sample()); }

  Region in_whole(Region box) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.first[axis] += region_.first[axis];
      box.end[axis] += region_.first[axis];
    }
    return box;
  }

  bool reads_parts() const {
    return narrowed_ || (parts_ != nullptr && whole_row() >= parts_->long_row() && row() <= whole_row() / 2);
  }

  void copy_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) const {
    const std::int64_t slice = (region_.first[2] + k) * whole_->info().dims[1];
    for (std::int64_t j = first; j < first + count; ++j, out = out.subspan(row())) {
      const std::int64_t from = (slice + region_.first[1] + j) * whole_->info().dims[0] + region_.first[0];
      std::memcpy(out.data(), whole_->held().data() + static_cast<std::size_t>(from) * sample(), row());
    }
  }

  void read_parts(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
    for (std::int64_t j = first; j < first + count; ++j, out = out.subspan(row())) {
      parts_->read_part_of_row(region_.first[2] + k, region_.first[1] + j, region_.first[0], out.first(row()));
    }
  }

  // Reads some rows of the whole at a time.
  void read_whole_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
    const auto most = static_cast<std::int64_t>(std::max<std::size_t>(kBlockBytes / whole_row(), 1));
    std::byte* to = out.data();
    for (std::int64_t j = first; j < first + count; j += most) {
      const std::int64_t rows = std::min(most, first + count - j);
      block_.resize(to_size(rows, whole_row()));
      reader_.read(region_.first[2] + k, region_.first[1] + j, rows, block_);
      const std::byte* from = block_.data() + static_cast<std::size_t>(region_.first[0]) * sample();
      for (std::int64_t n = 0; n < rows; ++n, from += whole_row(), to += row()) std::memcpy(to, from, row());
    }
  }

  std::unique_ptr<SliceSource> whole_;
  RowSource* parts_ = nullptr;  // the same, where parts of its rows can be read
  bool narrowed_ = false;       // they alone can be
  RowReader reader_;
  VolumeInfo info_;
  Region region_;
  SamplesOfBox needed_;           // of the whole: chunks beside the box are not read
  std::vector<std::byte> block_;  // rows of the whole
};

bool means_are_float32(SampleType type) { return sample_bytes(type) <= 2 || type == SampleType::kFloat32; }

class SmallerVolume final : public BufferedSource {
 public:
  SmallerVolume(std::unique_ptr<SliceSource> whole, std::int64_t step)
      : whole_(std::move(whole)),
        info_(smaller_info(whole_->info(), step)),
        step_(step),
        slice_(whole_->info().slice_bytes()) {
    info_.type = means_are_float32(info_.type) ? SampleType::kFloat32 : SampleType::kFloat64;
    sums_.resize(to_size(info_.slice_samples()));
    counts_.resize(sums_.size());
    if (whole_->info().type == SampleType::kFloat64) small_sums_.resize(sums_.size());
  }

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return whole_->skips(); }
  std::uint64_t held_bytes() const override {
    return held_by_slices(*whole_) + slice_.size() + (sums_.size() + small_sums_.size()) * sizeof(double) +
           counts_.size() * sizeof(std::uint64_t);
  }
  Region in_file(const Region& samples) const override {
    return samples_in_file(*whole_, blocks_in_whole(samples, whole_->info(), step_));
  }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    check_slice_range(info_, 0, first, count, out.size());
    for (std::int64_t k = first; k < first + count; ++k) {
      add_slices(k * step_, std::min((k + 1) * step_, whole_->info().dims[2]));
      std::byte* const slice = out.data() + static_cast<std::size_t>(k - first) * info_.slice_bytes();
      info_.type == SampleType::kFloat32 ? write_means<float>(slice) : write_means<double>(slice);
    }
  }

 private:
  void add_slices(std::int64_t first, std::int64_t end) {
    std::fill(sums_.begin(), sums_.end(), 0.0);
    std::fill(counts_.begin(), counts_.end(), 0U);
    std::fill(small_sums_.begin(), small_sums_.end(), 0.0);
    for (std::int64_t k = first; k < end; ++k) {
      whole_->read(k, 1, slice_);
      visit_sample_type(whole_->info().type, [&]<class T>() { add_slice<T>(); });
    }
  }

  template <class T>
  void add_slice() {
    const auto [nx, ny, nz] = whole_->info().dims;
    const T* sample = reinterpret_cast<const T*>(slice_.data());
    for (std::int64_t j = 0; j < ny; ++j) {
      const auto row = static_cast<std::size_t>(j / step_ * info_.dims[0]);
      for (std::int64_t i = 0; i < nx; ++i, ++sample) {
        const auto value = static_cast<double>(*sample);
        if (value != value) continue;
        const std::size_t block = row + static_cast<std::size_t>(i / step_);
        add_value<T>(block, value);
        ++counts_[block];
      }
    }
  }

  // A sum of float64 may be beyond the largest number where the mean is not. So a small part of each sample is summed
  // up as well.
  template <class T>
  void add_value(std::size_t block, double value) {
    sums_[block] += value;
    if constexpr (std::is_same_v<T, double>) small_sums_[block] += kSmall * value;
  }

  double mean_of(std::size_t block) const {
    const auto count = static_cast<double>(counts_[block]);
    const double mean = sums_[block] / count;
    if (std::isfinite(mean) || small_sums_.empty()) return mean;
    return small_sums_[block] / count / kSmall;
  }

  template <class T>
  void write_means(std::byte* out) const {
    for (std::size_t n = 0; n < sums_.size(); ++n) {
      const T mean = counts_[n] > 0 ? static_cast<T>(mean_of(n)) : std::numeric_limits<T>::quiet_NaN();
      std::memcpy(out + n * sizeof mean, &mean, sizeof mean);
    }
  }

  static constexpr double kSmall = 0x1p-62;

  std::unique_ptr<SliceSource> whole_;
  VolumeInfo info_;
  std::int64_t step_;
  std::vector<std::byte> slice_;    // of the whole
  std::vector<double> sums_;        // of the blocks of one slice
  std::vector<double> small_sums_;  // the same of samples times kSmall, where samples are float64
  std::vector<std::uint64_t> counts_;
};

}  // namespace

std::unique_ptr<SliceSource> crop_volume(std::unique_ptr<SliceSource> volume, const Region& region) {
  return std::make_unique<CroppedVolume>(std::move(volume), region);
}

std::unique_ptr<SliceSource> downsample_volume(std::unique_ptr<SliceSource> volume, std::int64_t step) {
  return std::make_unique<SmallerVolume>(std::move(volume), step);
}

}  // namespace isoweave
