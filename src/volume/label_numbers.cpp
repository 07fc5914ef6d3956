#include <cmath>
#include <string>
#include <type_traits>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "volume/labels.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr double kLargestWhole = 0x1p53;  // whole numbers up to it are doubles, all of them

bool is_whole(double number) { return std::abs(number) <= kLargestWhole && number == std::floor(number); }

VolumeInfo info_of(const VolumeInfo& volume) {
  if (!is_whole(volume.slope) || !is_whole(volume.intercept)) {
    bad_input(volume.path, "labels without a scaling, or scaled by whole numbers",
              "slope " + number_text(volume.slope) + " and intercept " + number_text(volume.intercept));
  }
  VolumeInfo info = volume;
  const bool is_scaled = volume.slope != 1 || volume.intercept != 0;
  if (is_scaled || !is_integer(volume.type)) info.type = SampleType::kInt64;
  info.slope = 1;
  info.intercept = 0;
  return info;
}

// Makes labels of the samples of one slice.
class Converter {
 public:
  Converter(const SliceSource& map, std::int64_t slice) : map_(map), volume_(map.info()), slice_(slice) {}

  template <class T>
  void convert(const T* samples, std::int64_t* labels) const {
    const std::int64_t count = volume_.slice_samples();
    for (std::int64_t n = 0; n < count; ++n) {
      if constexpr (std::is_integral_v<T>) {
        labels[n] = scaled(samples[n], n);
      } else {
        labels[n] = whole(volume_.slope * static_cast<double>(samples[n]) + volume_.intercept, n);
      }
    }
  }

 private:
  std::int64_t whole(double value, std::int64_t n) const {
    if (is_whole(value)) return static_cast<std::int64_t>(value);
    const bool beyond = std::abs(value) > kLargestWhole && std::isfinite(value);
    refuse(beyond ? "labels of at most 2^53 in a map of floats" : "whole numbers as labels", number_text(value), n);
  }

  template <class T>
  std::int64_t scaled(T sample, std::int64_t n) const {
    std::int64_t label = 0;
    const bool overflows = __builtin_mul_overflow(sample, static_cast<std::int64_t>(volume_.slope), &label) ||
                           __builtin_add_overflow(label, static_cast<std::int64_t>(volume_.intercept), &label);
    if (overflows) refuse("scaled labels of less than 2^63", std::to_string(sample) + " before scaling", n);
    return label;
  }

  [[noreturn]] void refuse(const std::string& expected, const std::string& found, std::int64_t n) const {
    const std::int64_t nx = volume_.dims[0];
    bad_input(volume_.path, expected, found + " in " + sample_in_file(map_, {n % nx, n / nx, slice_}));
  }

  const SliceSource& map_;
  const VolumeInfo& volume_;
  std::int64_t slice_;
};

}  // namespace

LabelNumbers::LabelNumbers(SliceSource& map) : map_(map), info_(info_of(map.info())) {
  if (!is_plain()) slice_.resize(map.info().slice_bytes());
}

std::span<const std::byte> LabelNumbers::held() const {
  if (is_plain()) return map_.held();
  return {};
}

void LabelNumbers::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  if (is_plain()) return map_.read(first, count, out);
  auto* labels = reinterpret_cast<std::int64_t*>(out.data());
  for (std::int64_t k = first; k < first + count; ++k, labels += info_.slice_samples()) {
    map_.read(k, 1, slice_);
    visit_sample_type(map_.info().type, [&]<class T>() {
      Converter(map_, k).convert(reinterpret_cast<const T*>(slice_.data()), labels);
    });
  }
}

}  // namespace isoweave
