#include "extract/values.hpp"

#include "extract/sample_view.hpp"
#include "lattice/value_rules.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kValuesBlock = 4096;

// The value at an index: interpolated along the axes on which a vertex lies between samples.
template <class T>
double value_at(const SampleView<T>& samples, const VertexNumbering::Place& place, const std::array<double, 3>& index) {
  std::array<double, 8> values;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t along = corner & place.direction;
    const auto step = [&](std::size_t axis) { return static_cast<std::int64_t>(along >> axis & 1); };
    values[corner] = samples.row(place.low[1] + step(1), place.low[2] + step(2))[place.low[0] + step(0)];
  }
  std::size_t left = 8;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    left /= 2;
    const double t = index[axis] - static_cast<double>(place.low[axis]);
    for (std::size_t n = 0; n < left; ++n) {
      values[n] = place.along(axis) ? value_between(values[2 * n], values[2 * n + 1], t) : values[2 * n];
    }
  }
  return values[0];
}

}  // namespace

void sample_values(const SliceWindow& window, const VertexNumbering& numbering, const std::array<double, 3>& spacing,
                   const Executor& executor, SurfacePiece& piece) {
  const VolumeInfo& volume = window.info();
  piece.values.resize(piece.positions.size());
  visit_sample_type(volume.type, [&]<class T>() {
    const SampleView<T> samples(window);
    executor.for_each(static_cast<std::int64_t>(piece.positions.size()), kValuesBlock, [&](std::int64_t n) {
      const auto v = static_cast<std::size_t>(n);
      const VertexNumbering::Place place = numbering.place(piece.ids[v]);
      const auto& at = piece.positions[v];
      const std::array<double, 3> index{at.x / spacing[0], at.y / spacing[1], at.z / spacing[2]};
      const double value = value_at(samples, place, index);
      piece.values[v] = static_cast<float>(volume.slope * value + volume.intercept);
    });
  });
}

}  // namespace isoweave
