// A label map made smaller.
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "isoweave/volume.hpp"
#include "parallel/size.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"
#include "volume/smaller.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

// Unsigned integers of a sample's size: labels are compared as they are stored.
template <class Visit>
void visit_stored(std::size_t bytes, const Visit& visit) {
  if (bytes == 1) visit(std::uint8_t{});
  if (bytes == 2) visit(std::uint16_t{});
  if (bytes == 4) visit(std::uint32_t{});
  if (bytes == 8) visit(std::uint64_t{});
}

// The most frequent value, of several the first one. `sorted` is room for a copy.
template <class T>
T most_frequent(const std::vector<T>& block, std::vector<T>& sorted) {
  if (std::ranges::all_of(block, [&](T value) { return value == block.front(); })) return block.front();
  sorted = block;
  std::ranges::sort(sorted);
  const auto count = [&](T value) {
    const auto [first, end] = std::equal_range(sorted.begin(), sorted.end(), value);
    return static_cast<std::size_t>(end - first);
  };
  std::size_t most = 0;
  for (std::size_t n = 0; n < sorted.size(); n += count(sorted[n])) most = std::max(most, count(sorted[n]));
  return *std::ranges::find_if(block, [&](T value) { return count(value) == most; });
}

class ThinnedLabels final : public BufferedSource {
 public:
  ThinnedLabels(std::unique_ptr<SliceSource> whole, std::int64_t step)
      : whole_(std::move(whole)), info_(smaller_info(whole_->info(), step)), step_(step) {
    slices_.resize(to_size(std::min(step, whole_->info().dims[2]), whole_->info().slice_bytes()));
  }

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return whole_->skips(); }
  std::uint64_t held_bytes() const override { return held_by_slices(*whole_) + slices_.size(); }
  Region in_file(const Region& samples) const override {
    return samples_in_file(*whole_, blocks_in_whole(samples, whole_->info(), step_));
  }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    check_slice_range(info_, 0, first, count, out.size());
    for (std::int64_t k = first; k < first + count; ++k) {
      const std::int64_t slices = std::min(step_, whole_->info().dims[2] - k * step_);
      whole_->read(k * step_, slices, std::span(slices_).first(to_size(slices, whole_->info().slice_bytes())));
      std::byte* const slice = out.data() + static_cast<std::size_t>(k - first) * info_.slice_bytes();
      visit_stored(sample_bytes(info_.type), [&]<class T>(T) { write_slice(slices, reinterpret_cast<T*>(slice)); });
    }
  }

 private:
  template <class T>
  void write_slice(std::int64_t slices, T* out) const {
    std::vector<T> block, sorted;
    for (std::int64_t j = 0; j < info_.dims[1]; ++j) {
      for (std::int64_t i = 0; i < info_.dims[0]; ++i) {
        fetch_block(i * step_, j * step_, slices, block);
        *out++ = most_frequent(block, sorted);
      }
    }
  }

  // The samples of a block, in the order in which they are stored.
  template <class T>
  void fetch_block(std::int64_t i, std::int64_t j, std::int64_t slices, std::vector<T>& block) const {
    const auto [nx, ny, nz] = whole_->info().dims;
    const T* const samples = reinterpret_cast<const T*>(slices_.data());
    block.clear();
    for (std::int64_t z = 0; z < slices; ++z) {
      for (std::int64_t y = j; y < std::min(j + step_, ny); ++y) {
        const T* const row = samples + (z * ny + y) * nx;
        block.insert(block.end(), row + i, row + std::min(i + step_, nx));
      }
    }
  }

  std::unique_ptr<SliceSource> whole_;
  VolumeInfo info_;
  std::int64_t step_;
  std::vector<std::byte> slices_;  // of the whole, those of one slice of blocks
};

}  // namespace

std::unique_ptr<SliceSource> thin_label_map(std::unique_ptr<SliceSource> map, std::int64_t step) {
  return std::make_unique<ThinnedLabels>(std::move(map), step);
}

}  // namespace isoweave
