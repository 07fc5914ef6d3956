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
#include "parallel/size.hpp"
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

// The mask of a label. Boxes and rows of it are those of the map, where the map has integers.
class LabelVolume final : public RowSource {
 public:
  LabelVolume(std::unique_ptr<SliceSource> map, Label label)
      : map_(std::move(map)),
        numbers_(*map_),
        rows_(numbers_.info().type == map_->info().type ? dynamic_cast<RowSource*>(map_.get()) : nullptr),
        reader_(rows_ != nullptr ? *map_ : static_cast<SliceSource&>(numbers_)),
        info_(numbers_.info()),
        label_(label) {
    info_.type = SampleType::kUint8;
  }

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return map_->skips(); }
  bool reads_parts_of_rows() const override { return rows_ != nullptr && rows_->reads_parts_of_rows(); }
  bool reads_boxes() const override { return rows_ != nullptr && rows_->reads_boxes(); }
  bool narrow(const Region& box) override { return rows_ != nullptr && rows_->narrow(box); }
  Gaps* gaps() override { return rows_ != nullptr ? rows_->gaps() : nullptr; }
  std::uint64_t held_bytes() const override {
    const std::uint64_t held = rows_ != nullptr ? held_by_rows(*map_) : held_by_rows(numbers_);
    return held + to_size(info_.slice_samples(), sample());
  }
  Region in_file(const Region& samples) const override { return samples_in_file(*map_, samples); }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    const auto slice = to_size(info_.slice_samples());
    for (std::int64_t k = first; k < first + count; ++k, out = out.subspan(slice)) read_rows(k, 0, info_.dims[1], out);
  }

  void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    labels_.resize(to_size(count * info_.dims[0], sample()));
    reader_.read(k, first, count, labels_);
    mask(count * info_.dims[0], out);
  }

  void read_part_of_row(std::int64_t k, std::int64_t j, std::int64_t i, std::span<std::byte> out) override {
    labels_.resize(out.size() * sample());
    rows_->read_part_of_row(k, j, i, labels_);
    mask(static_cast<std::int64_t>(out.size()), out);
  }

  std::optional<SampleBytes> constant() const override {
    const std::optional<SampleBytes> label = rows_ != nullptr ? rows_->constant() : std::nullopt;
    if (!label) return label;
    SampleBytes sample{};
    mask_row(label->data(), numbers_.info().type, 1, label_, reinterpret_cast<std::uint8_t*>(sample.data()));
    return sample;
  }

 private:
  std::size_t sample() const { return sample_bytes(numbers_.info().type); }

  void mask(std::int64_t samples, std::span<std::byte> out) const {
    mask_row(labels_.data(), numbers_.info().type, samples, label_, reinterpret_cast<std::uint8_t*>(out.data()));
  }

  std::unique_ptr<SliceSource> map_;
  LabelNumbers numbers_;
  RowSource* rows_;  // the map, where it has integers and rows
  RowReader reader_;
  VolumeInfo info_;
  Label label_;
  std::vector<std::byte> labels_;  // of the map
};

// Finds extents, run by run of equal samples. Labels of one map differ in their bits.
class ExtentFinder {
 public:
  // most: labels that there may be, where none are wanted by name.
  ExtentFinder(const VolumeInfo& volume, std::span<const Label> wanted, std::size_t most)
      : volume_(volume), all_(wanted.empty()), most_(most), most_counted_(std::max(kMostCounted, most)) {
    visit_sample_type(volume.type, [&]<class T>() {
      if constexpr (std::is_integral_v<T>) {
        for (const Label label : wanted) {
          if (is_of_type<T>(label)) extents_.emplace(label.bits(), LabelExtent{label, 0, {}});
        }
      }
    });
  }

  // Adds the samples of a part of the map, which begins at a place of the whole.
  void add(SliceSource& part, const std::array<std::int64_t, 3>& first, const std::atomic<bool>* stop) {
    LabelNumbers numbers(part);
    const VolumeInfo& info = numbers.info();
    std::vector<std::byte> slice(info.slice_bytes());
    for (std::int64_t k = 0; k < info.dims[2]; ++k) {
      if (stop != nullptr && stop->load()) throw Interrupted("interrupted, nothing was written");
      numbers.read(k, 1, slice);
      visit_sample_type(info.type, [&]<class T>() {
        const T* row = reinterpret_cast<const T*>(slice.data());
        for (std::int64_t j = 0; j < info.dims[1]; ++j, row += info.dims[0]) {
          add_row(std::span(row, to_size(info.dims[0])), {first[0], first[1] + j, first[2] + k});
        }
      });
    }
  }

  LabelExtent extent(Label label) const {
    const auto found = extents_.find(label.bits());
    return found != extents_.end() && found->second.label == label ? found->second : LabelExtent{label, 0, {}};
  }

  std::vector<LabelExtent> all() const {
    if (extents_.size() > most_) {
      const bool counted = extents_.size() <= most_counted_;
      bad_input(volume_.path, "a label map of at most " + std::to_string(most_) + " labels",
                (counted ? "" : "more than ") + std::to_string(std::min(extents_.size(), most_counted_)));
    }
    std::vector<LabelExtent> list;
    for (const auto& [bits, extent] : extents_) list.push_back(extent);
    std::ranges::sort(list, {}, &LabelExtent::label);
    return list;
  }

 private:
  template <class T>
  void add_row(std::span<const T> row, const std::array<std::int64_t, 3>& first) {
    for (std::size_t begin = 0, end = 0; begin < row.size(); begin = end) {
      end = begin + 1;
      while (end < row.size() && row[end] == row[begin]) ++end;
      if constexpr (std::is_integral_v<T>) {
        const std::int64_t at = first[0] + static_cast<std::int64_t>(begin);
        add_run(row[begin], {at, first[1], first[2]}, at + static_cast<std::int64_t>(end - begin));
      }
    }
  }

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
    if (!all_ || extents_.size() > most_counted_) return nullptr;
    return &extents_.emplace(label.bits(), LabelExtent{label, 0, {}}).first->second;
  }

  const VolumeInfo& volume_;
  bool all_;
  std::size_t most_, most_counted_;
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

namespace {

std::vector<LabelExtent> extents_in(const ExtentFinder& finder, std::span<const Label> wanted) {
  if (wanted.empty()) return finder.all();
  std::vector<LabelExtent> extents;
  for (const Label label : wanted) extents.push_back(finder.extent(label));
  return extents;
}

}  // namespace

std::vector<LabelExtent> find_labels(SliceSource& volume, std::span<const Label> wanted, const std::atomic<bool>* stop,
                                     std::size_t most) {
  const StandardFloats floats;
  const VolumeInfo info = LabelNumbers(volume).info();
  ExtentFinder finder(info, wanted, most);
  finder.add(volume, {0, 0, 0}, stop);
  return extents_in(finder, wanted);
}

std::vector<LabelExtent> find_labels_in_blocks(const VolumeOpener& open, std::int64_t size,
                                               std::span<const Label> wanted, const std::atomic<bool>* stop,
                                               std::size_t most) {
  const StandardFloats floats;
  const std::unique_ptr<SliceSource> whole = open();
  require_skipping(*whole);
  const VolumeInfo info = LabelNumbers(*whole).info();
  ExtentFinder finder(info, wanted, most);
  Region box;
  for (box.first[2] = 0; box.first[2] < info.dims[2]; box.first[2] += size) {
    for (box.first[1] = 0; box.first[1] < info.dims[1]; box.first[1] += size) {
      for (box.first[0] = 0; box.first[0] < info.dims[0]; box.first[0] += size) {
        for (std::size_t axis = 0; axis < 3; ++axis) box.end[axis] = std::min(box.first[axis] + size, info.dims[axis]);
        finder.add(*crop_volume(open(), box), box.first, stop);
      }
    }
  }
  return extents_in(finder, wanted);
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
