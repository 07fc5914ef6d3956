// Makes an index in one pass over the rows of a volume.
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "files/crc32.hpp"
#include "isoweave/error.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/size.hpp"
#include "volume/index_identity.hpp"
#include "volume/row_source.hpp"
#include "volume/volume_index.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlockBytes = 4 << 20;  // read at a time

// The bricks along an axis that hold a sample: two where neighbours share it.
std::pair<std::int64_t, std::int64_t> bricks_of(std::int64_t sample, std::int64_t bricks) {
  const std::int64_t last = std::min(sample / kBrick, bricks - 1);
  return {sample % kBrick == 0 && sample > 0 ? sample / kBrick - 1 : last, last};
}

// The ranges of the bricks, as far as rows have been added.
template <class T>
class BrickCounter {
 public:
  explicit BrickCounter(BrickLevel& bricks)
      : bricks_(bricks),
        low_(reinterpret_cast<T*>(bricks.low.data())),
        high_(reinterpret_cast<T*>(bricks.high.data())) {}

  void add_row(const T* samples, std::int64_t count, std::int64_t j, std::int64_t k) {
    const auto [first_j, last_j] = bricks_of(j, bricks_.size[1]);
    const auto [first_k, last_k] = bricks_of(k, bricks_.size[2]);
    for (std::int64_t i = 0; i < bricks_.size[0]; ++i) {
      const std::int64_t begin = i * kBrick;
      const Part part = part_of(samples + begin, std::min(kBrick + 1, count - begin));
      for (std::int64_t at_k = first_k; at_k <= last_k; ++at_k) {
        for (std::int64_t at_j = first_j; at_j <= last_j; ++at_j) merge(part, bricks_.at(i, at_j, at_k));
      }
    }
  }

 private:
  struct Part {
    T low, high;
    bool nan;
  };

  // The part of a row in a brick.
  static Part part_of(const T* samples, std::int64_t count) {
    constexpr bool kFloat = std::is_floating_point_v<T>;
    T low = kFloat ? std::numeric_limits<T>::infinity() : std::numeric_limits<T>::max();
    T high = kFloat ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::lowest();
    bool nan = false;
    for (std::int64_t n = 0; n < count; ++n) {
      const T value = samples[n];
      low = value < low ? value : low;
      high = high < value ? value : high;
      if constexpr (kFloat) nan |= std::isnan(value);
    }
    return {low, high, nan};
  }

  void merge(const Part& part, std::size_t at) {
    low_[at] = std::min(low_[at], part.low);
    high_[at] = std::max(high_[at], part.high);
    if (!bricks_.nan.empty()) bricks_.nan[at] |= static_cast<std::uint8_t>(part.nan);
  }

  BrickLevel& bricks_;
  T* low_;
  T* high_;
};

class IndexBuilder {
 public:
  explicit IndexBuilder(const VolumeInfo& info)
      : info_(info), slices_(to_size(info.dims[2])), bricks_(empty_bricks(info.dims, info.type)) {}

  // Adds rows [first, first + count) of slice k.
  void add(std::int64_t k, std::int64_t first, std::int64_t count, std::span<const std::byte> rows) {
    SliceFacts& slice = slices_[static_cast<std::size_t>(k)];
    slice.range.merge(sample_range(rows.data(), info_.type, count * info_.dims[0]));
    slice.crc = add_to_crc(slice.crc, rows);
    visit_sample_type(info_.type, [&]<class T>() {
      BrickCounter<T> counter(bricks_);
      const T* samples = reinterpret_cast<const T*>(rows.data());
      for (std::int64_t n = 0; n < count; ++n)
        counter.add_row(samples + n * info_.dims[0], info_.dims[0], first + n, k);
    });
  }

  std::shared_ptr<const VolumeIndex> finish(std::string identity) {
    return std::make_shared<VolumeIndex>(info_.dims, info_.type, std::move(identity), std::move(slices_),
                                         std::move(bricks_));
  }

 private:
  const VolumeInfo& info_;
  std::vector<SliceFacts> slices_;
  BrickLevel bricks_;
};

}  // namespace

std::shared_ptr<const VolumeIndex> build_index(SliceSource& volume, const std::atomic<bool>* stop) {
  const StandardFloats floats;
  const VolumeInfo& info = volume.info();
  checked_volume_bytes(info);
  const std::string identity = volume_identity(info);
  IndexBuilder builder(info);
  const std::int64_t row = info.dims[0] * static_cast<std::int64_t>(sample_bytes(info.type));
  const std::int64_t rows = std::clamp<std::int64_t>(kBlockBytes / row, 1, info.dims[1]);
  std::vector<std::byte> block(to_size(rows * row));
  RowReader reader(volume);
  for (std::int64_t k = 0; k < info.dims[2]; ++k) {
    for (std::int64_t j = 0; j < info.dims[1]; j += rows) {
      if (stop != nullptr && stop->load()) throw Interrupted("interrupted, nothing was written");
      const std::int64_t count = std::min(rows, info.dims[1] - j);
      reader.read(k, j, count, block);
      builder.add(k, j, count, std::span(block).first(to_size(count * row)));
    }
  }
  if (volume_identity(info) != identity) {
    throw BadInput(info.path + ": expected a file that stays as it is while it is read, found it changed");
  }
  return builder.finish(identity);
}

}  // namespace isoweave
