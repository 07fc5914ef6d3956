#include "volume/volume_index.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "parallel/size.hpp"

namespace isoweave {
namespace {

template <class T>
std::span<T> typed(std::vector<std::byte>& bytes) {
  return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
}

template <class T>
std::span<const T> typed(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

BrickLevel empty_level(const std::array<std::int64_t, 3>& size, SampleType type) {
  BrickLevel level;
  level.size = size;
  const std::size_t count = to_size(size[0] * size[1] * size[2]);
  level.low.resize(to_size(count, sample_bytes(type)));
  level.high.resize(level.low.size());
  visit_sample_type(type, [&]<class T>() {
    constexpr bool kFloat = std::is_floating_point_v<T>;
    constexpr T kHighest = kFloat ? std::numeric_limits<T>::infinity() : std::numeric_limits<T>::max();
    constexpr T kLowest = kFloat ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::lowest();
    std::ranges::fill(typed<T>(level.low), kHighest);
    std::ranges::fill(typed<T>(level.high), kLowest);
    if (kFloat) level.nan.resize(count);
  });
  return level;
}

BrickLevel coarser(const BrickLevel& fine, SampleType type) {
  BrickLevel level = empty_level({(fine.size[0] + 1) / 2, (fine.size[1] + 1) / 2, (fine.size[2] + 1) / 2}, type);
  visit_sample_type(type, [&]<class T>() {
    const std::span<const T> fine_low = typed<T>(fine.low), fine_high = typed<T>(fine.high);
    const std::span<T> low = typed<T>(level.low), high = typed<T>(level.high);
    for (std::int64_t k = 0; k < fine.size[2]; ++k) {
      for (std::int64_t j = 0; j < fine.size[1]; ++j) {
        for (std::int64_t i = 0; i < fine.size[0]; ++i) {
          const std::size_t from = fine.at(i, j, k), to = level.at(i / 2, j / 2, k / 2);
          low[to] = std::min(low[to], fine_low[from]);
          high[to] = std::max(high[to], fine_high[from]);
          if (!fine.nan.empty()) level.nan[to] |= fine.nan[from];
        }
      }
    }
  });
  return level;
}

}  // namespace

VolumeIndex::VolumeIndex(const std::array<std::int64_t, 3>& dims, SampleType type, std::string identity,
                         std::vector<SliceFacts> slices, BrickLevel finest)
    : dims_(dims), type_(type), identity_(std::move(identity)), slices_(std::move(slices)) {
  levels_.push_back(std::move(finest));
  while (levels_.back().count() > 1) levels_.push_back(coarser(levels_.back(), type));
}

std::uint64_t VolumeIndex::bytes() const {
  std::uint64_t bytes = slices_.size() * sizeof(SliceFacts);
  for (const BrickLevel& level : levels_) bytes += level.low.size() + level.high.size() + level.nan.size();
  return bytes;
}

BrickLevel empty_bricks(const std::array<std::int64_t, 3>& dims, SampleType type) {
  return empty_level({bricks_along(dims[0]), bricks_along(dims[1]), bricks_along(dims[2])}, type);
}

void require_index_of(const VolumeIndex& index, const VolumeInfo& volume) {
  if (index.dims() == volume.dims && index.type() == volume.type) return;
  throw std::invalid_argument(volume.path + ": expected an index of this volume, found one of another size or type");
}

IndexFacts index_facts(const VolumeIndex& index) {
  return {index.dims(), index.type(), kBrick, static_cast<std::int64_t>(index.levels().front().count()), index.bytes()};
}

}  // namespace isoweave
