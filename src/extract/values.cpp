#include "extract/values.hpp"

#include "extract/sample_view.hpp"
#include "lattice/value_rules.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 4096;

}  // namespace

void sample_values(const SliceWindow& window, const Lattice& lattice, const std::array<double, 3>& spacing,
                   const Executor& executor, SurfacePiece& piece) {
  const VolumeInfo& volume = window.info();
  piece.values.resize(piece.positions.size());
  visit_sample_type(volume.type, [&]<class T>() {
    const SampleView<T> samples(window);
    executor.for_each(static_cast<std::int64_t>(piece.positions.size()), kBlock, [&](std::int64_t n) {
      const auto v = static_cast<std::size_t>(n);
      const Lattice::Edge edge = lattice.edge(piece.ids[v]);
      const auto [i, j, k] = edge.low;
      const double low = samples.row(j, k)[i];
      const double high = samples.row(j + (edge.axis == 1), k + (edge.axis == 2))[i + (edge.axis == 0)];
      const Vec3& at = piece.positions[v];
      const double along[3] = {at.x, at.y, at.z};
      const double t = along[edge.axis] / spacing[edge.axis] - static_cast<double>(edge.low[edge.axis]);
      piece.values[v] = static_cast<float>(volume.slope * value_between(low, high, t) + volume.intercept);
    });
  });
}

}  // namespace isoweave
