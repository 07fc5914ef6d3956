#include "extract/values.hpp"

#include "extract/sample_view.hpp"
#include "lattice/value_rules.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 4096;

}  // namespace

void sample_values(const SliceWindow& window, const VertexNumbering& numbering, const std::array<double, 3>& spacing,
                   const Executor& executor, SurfacePiece& piece) {
  const VolumeInfo& volume = window.info();
  piece.values.resize(piece.positions.size());
  visit_sample_type(volume.type, [&]<class T>() {
    const SampleView<T> samples(window);
    executor.for_each(static_cast<std::int64_t>(piece.positions.size()), kBlock, [&](std::int64_t n) {
      const auto v = static_cast<std::size_t>(n);
      const VertexNumbering::Place place = numbering.place(piece.ids[v]);
      const std::size_t axis = place.along(0) ? 0 : place.along(1) ? 1 : 2;
      const auto [i, j, k] = place.low;
      const double low = samples.row(j, k)[i];
      const double high = samples.row(j + place.along(1), k + place.along(2))[i + place.along(0)];
      const Vec3& at = piece.positions[v];
      const double along[3] = {at.x, at.y, at.z};
      const double t = along[axis] / spacing[axis] - static_cast<double>(place.low[axis]);
      piece.values[v] = static_cast<float>(volume.slope * value_between(low, high, t) + volume.intercept);
    });
  });
}

}  // namespace isoweave
