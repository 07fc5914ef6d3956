#include "volume/even_slices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>

#include "volume/samples.hpp"
#include "volume/threshold.hpp"

namespace isoweave {
namespace {

template <class T>
T between(T low, T high, double weight) {
  const double value = std::lerp(static_cast<double>(low), static_cast<double>(high), weight);
  constexpr double kHalf = 0.5;
  if constexpr (std::is_integral_v<T>) return nearest_integer<T>(std::floor(value + kHalf));
  return static_cast<T>(value);
}

template <class T>
void interpolate(std::span<const std::byte> low, std::span<const std::byte> high, double weight,
                 std::span<std::byte> out) {
  const T* const a = reinterpret_cast<const T*>(low.data());
  const T* const b = reinterpret_cast<const T*>(high.data());
  T* const result = reinterpret_cast<T*>(out.data());
  for (std::size_t n = 0; n < out.size() / sizeof(T); ++n) result[n] = between(a[n], b[n], weight);
}

class EvenSliceStream final : public ByteStream {
 public:
  EvenSliceStream(std::unique_ptr<ByteStream> slices, EvenGrid grid, SampleType type, std::size_t slice_bytes)
      : slices_(std::move(slices)), grid_(std::move(grid)), type_(type), slice_bytes_(slice_bytes) {}

  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size() && current_ < grid_.count) {
      if (slice_.empty()) slice_ = made(grid_.place(current_));
      if (slice_.empty()) break;
      const std::size_t step = std::min(out.size() - done, slice_bytes_ - used_);
      std::copy_n(slice_.begin() + static_cast<std::ptrdiff_t>(used_), step,
                  out.begin() + static_cast<std::ptrdiff_t>(done));
      done += step;
      advance(step);
    }
    return done;
  }

  std::uint64_t skip(std::uint64_t count) override {
    std::uint64_t done = 0;
    while (done < count && current_ < grid_.count) {
      const std::uint64_t step = std::min<std::uint64_t>(count - done, slice_bytes_ - used_);
      done += step;
      advance(static_cast<std::size_t>(step));
    }
    return done;
  }

 private:
  struct Held {
    std::int64_t number = -1;
    std::vector<std::byte> samples;
  };

  void advance(std::size_t bytes) {
    used_ += bytes;
    if (used_ < slice_bytes_) return;
    used_ = 0;
    ++current_;
    slice_ = {};
  }

  // A slice of the input, which is read unless it is held. Empty when the input ends before it.
  std::span<const std::byte> original(std::int64_t number) {
    Held& held = held_[static_cast<std::size_t>(number % 2)];
    if (held.number == number) return held.samples;
    held.samples.resize(slice_bytes_);
    const std::uint64_t before = static_cast<std::uint64_t>(number - next_) * slice_bytes_;
    held.number = -1;
    if (slices_->skip(before) < before || slices_->read(held.samples) < slice_bytes_) return {};
    held.number = number;
    next_ = number + 1;
    return held.samples;
  }

  std::span<const std::byte> made(const EvenGrid::Place& place) {
    const std::span<const std::byte> low = original(place.lower);
    if (place.weight == 0 || low.empty()) return low;
    const std::span<const std::byte> high = original(place.lower + 1);
    if (high.empty()) return {};
    between_.resize(slice_bytes_);
    visit_sample_type(type_, [&]<class T>() { interpolate<T>(low, high, place.weight, between_); });
    return between_;
  }

  std::unique_ptr<ByteStream> slices_;
  EvenGrid grid_;
  SampleType type_;
  std::size_t slice_bytes_;
  std::array<Held, 2> held_;  // even and odd numbers
  std::int64_t next_ = 0;     // slice that the input stands at
  std::vector<std::byte> between_;
  std::int64_t current_ = 0;  // slice of the grid
  std::size_t used_ = 0;      // bytes of it
  std::span<const std::byte> slice_;
};

}  // namespace

double EvenGrid::distance() const {
  return count > 1 ? (depths.back() - depths.front()) / static_cast<double>(count - 1) : 0;
}

EvenGrid::Place EvenGrid::place(std::int64_t slice) const {
  if (!is_resampled) return {slice, 0};
  const double depth = depths.front() + distance() * static_cast<double>(slice);
  const auto above = std::upper_bound(depths.begin() + 1, depths.end() - 1, depth);
  const auto lower = static_cast<std::int64_t>(above - depths.begin()) - 1;
  const double from = *(above - 1);
  if (depth - from <= slack) return {lower, 0};
  if (*above - depth <= slack) return {lower + 1, 0};
  return {lower, (depth - from) / (*above - from)};
}

std::unique_ptr<ByteStream> even_slices(std::unique_ptr<ByteStream> slices, const EvenGrid& grid, SampleType type,
                                        std::size_t slice_bytes) {
  if (!grid.is_resampled) return slices;
  return std::make_unique<EvenSliceStream>(std::move(slices), grid, type, slice_bytes);
}

}  // namespace isoweave
