#include "plain_rules/volume_surface.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "plain_rules/riders.hpp"

namespace isoweave::plain {
namespace {

constexpr double kMargin = 1.0 / 256;  // of a crossing, from both ends of its lattice edge

using Index = std::array<std::int64_t, 3>;

template <class Sample>
std::vector<double> numbers_of(std::span<const std::byte> bytes) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Sample)) {
    Sample sample{};
    std::memcpy(&sample, &bytes[at], sizeof sample);
    numbers.push_back(static_cast<double>(sample));
  }
  return numbers;
}

std::vector<double> numbers_of(SampleType type, std::span<const std::byte> bytes) {
  switch (type) {
    case SampleType::kUint8:
      return numbers_of<std::uint8_t>(bytes);
    case SampleType::kInt8:
      return numbers_of<std::int8_t>(bytes);
    case SampleType::kUint16:
      return numbers_of<std::uint16_t>(bytes);
    case SampleType::kInt16:
      return numbers_of<std::int16_t>(bytes);
    case SampleType::kUint32:
      return numbers_of<std::uint32_t>(bytes);
    case SampleType::kInt32:
      return numbers_of<std::int32_t>(bytes);
    case SampleType::kUint64:
      return numbers_of<std::uint64_t>(bytes);
    case SampleType::kInt64:
      return numbers_of<std::int64_t>(bytes);
    case SampleType::kFloat32:
      return numbers_of<float>(bytes);
    case SampleType::kFloat64:
      return numbers_of<double>(bytes);
  }
  throw std::logic_error("a type without a name");
}

double cube_root(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  for (; exponent % 3 != 0; --exponent) mantissa *= 2;
  double root = 1;
  for (int step = 0; step < 8; ++step) root = (2 * root + mantissa / (root * root)) / 3;
  return std::ldexp(root, exponent / 3);
}

// Where the surface crosses a lattice edge.
struct Crossing {
  Index low{};
  std::size_t axis = 0;
  double at_low = 0, at_high = 0;  // samples
  double t = 0;                    // from low on
  bool low_inside = false;
};

class Crossings {
 public:
  Crossings(const Samples& volume, const MeshOptions& options)
      : volume_(volume),
        spacing_(volume.info.geometry.spacing),
        iso_((options.iso - volume.info.intercept) / volume.info.slope),
        above_(options.inside_above == (volume.info.slope > 0)) {}

  Crossing find(const Point& p) const {
    Crossing crossing;
    int axes = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const double index = double{p[n]} / spacing_[n];
      crossing.low[n] = std::llround(index);
      if (std::abs(index - std::round(index)) < kMargin / 2) continue;
      crossing.low[n] = static_cast<std::int64_t>(std::floor(index));
      crossing.axis = n;
      ++axes;
    }
    if (axes != 1) throw std::logic_error("a vertex that is not on one lattice edge");
    fill(crossing);
    return crossing;
  }

  Vector place(const Crossing& crossing) const {
    Vector place{};
    for (std::size_t n = 0; n < 3; ++n) {
      const auto index = static_cast<double>(crossing.low[n]);
      place[n] = (n == crossing.axis ? index + crossing.t : index) * spacing_[n];
    }
    return place;
  }

  Point normal(const Crossing& crossing) const {
    if (std::isnan(crossing.at_low) != std::isnan(crossing.at_high)) {
      Point cap{};
      cap[crossing.axis] = crossing.low_inside ? 1.0F : -1.0F;
      return cap;
    }
    Index high = crossing.low;
    ++high[crossing.axis];
    const Vector low_gradient = gradient(crossing.low);
    const Vector slope = low_gradient + crossing.t * (gradient(high) - low_gradient);
    return unit_normal(above_ ? -1.0 * slope : slope);
  }

 private:
  bool is_inside(double sample) const { return above_ ? sample >= iso_ : sample <= iso_; }

  void fill(Crossing& crossing) const {
    Index high = crossing.low;
    ++high[crossing.axis];
    crossing.at_low = volume_.at(crossing.low);
    crossing.at_high = volume_.at(high);
    crossing.low_inside = is_inside(crossing.at_low);
    const double t = (iso_ - crossing.at_low) / (crossing.at_high - crossing.at_low);
    const double beside_inside = crossing.low_inside ? kMargin : 1 - kMargin;
    crossing.t = std::isnan(t) ? beside_inside : std::clamp(t, kMargin, 1 - kMargin);
  }

  Vector gradient(const Index& at) const {
    Vector slope{};
    for (std::size_t n = 0; n < 3; ++n) {
      Index before = at;
      Index behind = at;
      --before[n];
      ++behind[n];
      const double low = volume_.at(before);
      const double high = volume_.at(behind);
      const int steps = (std::isnan(low) ? 0 : 1) + (std::isnan(high) ? 0 : 1);
      if (steps == 0) continue;
      const double rise = (std::isnan(high) ? volume_.at(at) : high) - (std::isnan(low) ? volume_.at(at) : low);
      slope[n] = rise / (steps * spacing_[n]);
    }
    return slope;
  }

  const Samples& volume_;
  std::array<double, 3> spacing_;
  double iso_;
  bool above_;
};

// Twice the mean area, summed in blocks of 4096 triangles.
double mean_face(const TriangleMesh& mesh) {
  constexpr std::size_t kBlock = 4096;
  double sum = 0;
  for (std::size_t begin = 0; begin < mesh.triangles.size(); begin += kBlock) {
    double block = 0;
    for (std::size_t t = begin; t < std::min(begin + kBlock, mesh.triangles.size()); ++t) {
      std::array<Vector, 3> p{};
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t n = 0; n < 3; ++n) p[c][n] = mesh.vertices[mesh.triangles[t][c]][n];
      }
      block += length(cross(p[1] - p[0], p[2] - p[0]));
    }
    sum += block;
  }
  const double area = sum / 2 / static_cast<double>(mesh.triangles.size());
  return area > 0 ? 2 * area : 1;
}

}  // namespace

double Samples::at(const std::array<std::int64_t, 3>& index) const {
  for (std::size_t n = 0; n < 3; ++n) {
    if (index[n] < 0 || index[n] >= info.dims[n]) return std::numeric_limits<double>::quiet_NaN();
  }
  return numbers[static_cast<std::size_t>((index[2] * info.dims[1] + index[1]) * info.dims[0] + index[0])];
}

Samples read_samples(SliceSource& volume) {
  const VolumeInfo& info = volume.info();
  std::vector<std::byte> bytes(static_cast<std::size_t>(info.dims[2]) * info.slice_bytes());
  volume.read(0, info.dims[2], bytes);
  return {info, numbers_of(info.type, bytes)};
}

Surface surface_of(const Samples& volume, const TriangleMesh& extracted, const MeshOptions& options) {
  const Crossings crossings(volume, options);
  const auto& spacing = volume.info.geometry.spacing;
  const double voxel = cube_root(spacing[0] * spacing[1] * spacing[2]);
  Surface surface;
  surface.row = static_cast<std::uint64_t>(volume.info.dims[0]) + 2;
  surface.plane = surface.row * (static_cast<std::uint64_t>(volume.info.dims[1]) + 2);
  surface.face = voxel * voxel;
  surface.layer = spacing[2];
  for (std::size_t v = 0; v < extracted.vertices.size(); ++v) {
    const Crossing crossing = crossings.find(extracted.vertices[v]);
    const auto padded = [&](std::size_t n) { return static_cast<std::uint64_t>(crossing.low[n] + 1); };
    Corner corner;
    corner.place = crossings.place(crossing);
    corner.id = 3 * (padded(2) * surface.plane + padded(1) * surface.row + padded(0)) + crossing.axis;
    corner.normal = crossings.normal(crossing);
    if (!extracted.values.empty()) corner.value = extracted.values[v];
    surface.corners.push_back(corner);
  }
  for (const auto& [a, b, c] : extracted.triangles) surface.triangles.push_back({a, b, c});
  return surface;
}

Surface surface_of(const TriangleMesh& mesh) {
  Surface surface;
  surface.face = mean_face(mesh);
  surface.layer = std::sqrt(surface.face);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto& [x, y, z] = mesh.vertices[v];
    surface.corners.push_back({{x, y, z}, v, {}, mesh.values.empty() ? 0 : mesh.values[v]});
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    if (a != b && b != c && c != a) surface.triangles.push_back({a, b, c});
  }
  return surface;
}

void keep(const ComponentRule& rule, Surface& surface) {
  std::vector<std::size_t> first(surface.corners.size());  // corner of the component
  std::iota(first.begin(), first.end(), std::size_t{0});
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b, c] : surface.triangles) {
      const std::size_t least = std::min({first[a], first[b], first[c]});
      changed = changed || first[a] != least || first[b] != least || first[c] != least;
      first[a] = first[b] = first[c] = least;
    }
  }
  std::map<std::size_t, std::uint64_t> triangles;
  for (const auto& triangle : surface.triangles) ++triangles[first[triangle[0]]];
  const auto largest = std::ranges::max_element(triangles, {}, [](const auto& component) { return component.second; });
  std::erase_if(surface.triangles, [&](const auto& triangle) {
    const std::size_t component = first[triangle[0]];
    return triangles[component] < rule.min_triangles || (rule.largest && component != largest->first);
  });
}

}  // namespace isoweave::plain
