#include "pipeline/cap_samples.hpp"

#include <array>

#include "volume/samples.hpp"
#include "volume/threshold.hpp"

namespace isoweave {
namespace {

template <class T>
std::uint64_t count_in_faces(const T* slice, std::int64_t k, const std::array<std::int64_t, 3>& dims,
                             const IsoRule& rule) {
  const Threshold<T> threshold = threshold_for<T>(rule.iso, rule.above);
  if (!threshold.reachable) return 0;
  const auto [nx, ny, nz] = dims;
  std::uint64_t inside = 0;
  const auto count = [&](std::int64_t first, std::int64_t samples, std::int64_t step) {
    for (std::int64_t n = 0; n < samples; ++n) {
      const T sample = slice[first + n * step];
      inside += static_cast<std::uint64_t>(rule.above ? sample >= threshold.value : sample <= threshold.value);
    }
  };
  count(0, nx, 1);
  count((ny - 1) * nx, nx, 1);
  count(0, ny, nx);
  count(nx - 1, ny, nx);
  if (k == 0) count(0, nx * ny, 1);
  if (k == nz - 1) count(0, nx * ny, 1);
  return inside;
}

}  // namespace

std::uint64_t count_cap_samples(const std::byte* slice, std::int64_t k, const VolumeInfo& volume, const IsoRule& rule) {
  return visit_sample_type(
      volume.type, [&]<class T>() { return count_in_faces(reinterpret_cast<const T*>(slice), k, volume.dims, rule); });
}

}  // namespace isoweave
