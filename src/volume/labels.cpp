#include "volume/labels.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "files/input_file.hpp"
#include "isoweave/error.hpp"
#include "parallel/float_environment.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kMostCounted = std::size_t{1} << 20;  // labels, before it is no matter how many more there are

// Whether numbers of a type can be the label.
template <class T>
bool is_of_type(Label label) {
  if (!label.is_negative()) return label.bits() <= static_cast<std::uint64_t>(std::numeric_limits<T>::max());
  return std::is_signed_v<T> && Label(std::numeric_limits<T>::lowest()) <= label;
}

class LabelVolume final : public SliceSource {
 public:
  LabelVolume(std::unique_ptr<SliceSource> map, Label label)
      : map_(std::move(map)), numbers_(*map_), info_(numbers_.info()), label_(label), slice_(info_.slice_bytes()) {
    info_.type = SampleType::kUint8;
  }

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return map_->skips(); }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    auto* mask = reinterpret_cast<std::uint8_t*>(out.data());
    for (std::int64_t k = first; k < first + count; ++k, mask += info_.slice_samples()) {
      numbers_.read(k, 1, slice_);
      mask_row(slice_.data(), numbers_.info().type, info_.slice_samples(), label_, mask);
    }
  }

 private:
  std::unique_ptr<SliceSource> map_;
  LabelNumbers numbers_;
  VolumeInfo info_;
  Label label_;
  std::vector<std::byte> slice_;  // of the map
};

// Finds extents, run by run of equal samples. Labels of one map differ in their bits.
class ExtentFinder {
 public:
  ExtentFinder(const VolumeInfo& volume, std::span<const Label> wanted) : volume_(volume), all_(wanted.empty()) {
    visit_sample_type(volume.type, [&]<class T>() {
      if constexpr (std::is_integral_v<T>) {
        for (const Label label : wanted) {
          if (is_of_type<T>(label)) extents_.emplace(label.bits(), LabelExtent{label, 0, {}});
        }
      }
    });
  }

  template <class T>
  void add_row(const T* row, std::int64_t j, std::int64_t k) {
    const std::int64_t nx = volume_.dims[0];
    for (std::int64_t begin = 0, end = 0; begin < nx; begin = end) {
      end = begin + 1;
      while (end < nx && row[end] == row[begin]) ++end;
      if constexpr (std::is_integral_v<T>) add_run(row[begin], {begin, j, k}, end);
    }
  }

  LabelExtent extent(Label label) const {
    const auto found = extents_.find(label.bits());
    return found != extents_.end() && found->second.label == label ? found->second : LabelExtent{label, 0, {}};
  }

  std::vector<LabelExtent> all() const {
    if (extents_.size() > kMostLabels) {
      const bool counted = extents_.size() <= kMostCounted;
      bad_input(volume_.path, "a label map of at most " + std::to_string(kMostLabels) + " labels",
                (counted ? "" : "more than ") + std::to_string(std::min(extents_.size(), kMostCounted)));
    }
    std::vector<LabelExtent> list;
    for (const auto& [bits, extent] : extents_) list.push_back(extent);
    std::ranges::sort(list, {}, &LabelExtent::label);
    return list;
  }

 private:
  void add_run(Label label, const std::array<std::int64_t, 3>& first, std::int64_t end) {
    LabelExtent* const extent = find(label);
    if (extent == nullptr) return;
    const std::array<std::int64_t, 3> last{end, first[1] + 1, first[2] + 1};
    if (extent->samples == 0) extent->box = {first, last};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      extent->box.first[axis] = std::min(extent->box.first[axis], first[axis]);
      extent->box.end[axis] = std::max(extent->box.end[axis], last[axis]);
    }
    extent->samples += static_cast<std::uint64_t>(end - first[0]);
    ++extent->runs;
  }

  // The extent of a label, or null where the label is not asked for.
  LabelExtent* find(Label label) {
    if (all_ && label == 0) return nullptr;
    const auto found = extents_.find(label.bits());
    if (found != extents_.end()) return &found->second;
    if (!all_ || extents_.size() > kMostCounted) return nullptr;
    return &extents_.emplace(label.bits(), LabelExtent{label, 0, {}}).first->second;
  }

  const VolumeInfo& volume_;
  bool all_;
  std::unordered_map<std::uint64_t, LabelExtent> extents_;
};

// Whether a label looks like a grey value: a sheet of one or two samples that winds through all of the image.
bool is_scattered(const LabelExtent& label) {
  constexpr double kThin = 3;       // samples of a run, on average
  constexpr double kSparse = 0.02;  // of the box
  const auto samples = static_cast<double>(label.samples);
  double box = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) box *= static_cast<double>(label.box.end[axis] - label.box.first[axis]);
  return samples < kThin * static_cast<double>(label.runs) && samples < kSparse * box;
}

}  // namespace

void mask_row(const std::byte* samples, SampleType type, std::int64_t count, Label label, std::uint8_t* mask) {
  visit_sample_type(type, [&]<class T>() {
    if constexpr (std::is_integral_v<T>) {
      const T* const row = reinterpret_cast<const T*>(samples);
      const bool possible = is_of_type<T>(label);
      const T wanted = static_cast<T>(possible ? label.bits() : 0);
      for (std::int64_t i = 0; i < count; ++i) mask[i] = possible && row[i] == wanted ? 1 : 0;
    }
  });
}

std::unique_ptr<SliceSource> label_volume(std::unique_ptr<SliceSource> volume, Label label) {
  return std::make_unique<LabelVolume>(std::move(volume), label);
}

std::vector<LabelExtent> find_labels(SliceSource& volume, std::span<const Label> wanted,
                                     const std::atomic<bool>* stop) {
  const StandardFloats floats;
  LabelNumbers numbers(volume);
  const VolumeInfo& info = numbers.info();
  ExtentFinder finder(info, wanted);
  std::vector<std::byte> slice(info.slice_bytes());
  for (std::int64_t k = 0; k < info.dims[2]; ++k) {
    if (stop != nullptr && stop->load()) throw Interrupted("interrupted, nothing was written");
    numbers.read(k, 1, slice);
    visit_sample_type(info.type, [&]<class T>() {
      const T* row = reinterpret_cast<const T*>(slice.data());
      for (std::int64_t j = 0; j < info.dims[1]; ++j, row += info.dims[0]) finder.add_row(row, j, k);
    });
  }
  if (wanted.empty()) return finder.all();
  std::vector<LabelExtent> extents;
  for (const Label label : wanted) extents.push_back(finder.extent(label));
  return extents;
}

std::size_t count_scattered(std::span<const LabelExtent> labels) {
  return static_cast<std::size_t>(std::ranges::count_if(labels, is_scattered));
}

bool look_like_labels(std::span<const LabelExtent> labels) {
  constexpr std::size_t kFew = 16;
  return labels.size() < kFew || 2 * count_scattered(labels) <= labels.size();
}

bool looks_like_label_map(std::unique_ptr<SliceSource> volume, const std::atomic<bool>* stop) {
  constexpr std::int64_t kMostSlices = 64;
  Region middle{{0, 0, 0}, volume->info().dims};
  const std::int64_t more = std::max<std::int64_t>(volume->info().dims[2] - kMostSlices, 0);
  middle.first[2] = more / 2;
  middle.end[2] -= more - more / 2;
  const std::unique_ptr<SliceSource> part = crop_volume(std::move(volume), middle);
  try {
    const std::vector<LabelExtent> labels = find_labels(*part, {}, stop);
    return !labels.empty() && !labels.front().label.is_negative() && look_like_labels(labels);
  } catch (const BadInput&) {
    return false;  // fractions, or more values than a map has labels
  }
}

}  // namespace isoweave
