#include "isoweave/placed_sink.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "files/length_units.hpp"
#include "isoweave/measure.hpp"
#include "parallel/float_environment.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kAtOnce = 4096;  // vertices or triangles of a piece

using Place = std::array<double, 3>;

Place scaled(const Point& point, const Place& offset, double scale) {
  Place place{};
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = scale * (offset[axis] + double{point[axis]});
  return place;
}

// The vector that is added to scaled coordinates.
Place shift_of(std::span<const Point> points, const Place& offset, const MeshPlacing& placing) {
  Place low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Point& point : points) {
    const Place place = scaled(point, offset, placing.scale);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], place[axis]);
      high[axis] = std::max(high[axis], place[axis]);
    }
  }
  Place shift{0, 0, 0};
  if (points.empty()) return shift;
  for (std::size_t axis = 0; axis < 3 && placing.center; ++axis) shift[axis] = -(low[axis] + high[axis]) / 2;
  if (placing.ground) shift[2] = -low[2];
  return shift;
}

// Part `first` of an array that may be there or not.
template <class Item>
std::span<const Item> part(std::span<const Item> items, std::size_t first) {
  return items.empty() ? items : items.subspan(first, std::min(kAtOnce, items.size() - first));
}

}  // namespace

double unit_ratio(const std::string& from, const std::string& to) {
  const std::optional<LengthUnit> unit = find_length_unit(unit_or_usual(from));
  const std::optional<double> ratio = unit ? unit_in(*unit, to) : std::nullopt;
  if (!ratio) throw std::invalid_argument("unit: expected m, mm, um, nm or in, found '" + (unit ? to : from) + "'");
  return *ratio;
}

std::array<double, 3> placed_offset(const std::array<double, 3>& offset, const MeshPlacing& placing) {
  if (placing.center) return {0, 0, 0};
  const double z = placing.ground ? 0 : placing.scale * offset[2];
  return {placing.scale * offset[0], placing.scale * offset[1], z};
}

PlacedSink::PlacedSink(std::unique_ptr<MeshSink> sink, const std::array<double, 3>& offset, const MeshPlacing& placing)
    : sink_(std::move(sink)), mesh_(offset), placing_(placing) {
  if (!(placing.scale > 0) || std::isinf(placing.scale)) {
    throw std::invalid_argument("scale: expected a finite number above 0");
  }
}

void PlacedSink::finish() {
  const StandardFloats floats;
  const Place offset = sink_->offset();
  const Place shift = shift_of(mesh_.vertices(), mesh_.offset(), placing_);
  std::vector<Point> points;
  points.reserve(mesh_.vertices().size());
  for (const Point& point : mesh_.vertices()) {
    const Place place = scaled(point, mesh_.offset(), placing_.scale);
    Point& moved = points.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved[axis] = static_cast<float>(place[axis] + shift[axis] - offset[axis]);
      if (!std::isfinite(moved[axis]))
        throw std::invalid_argument("scale: expected one with which 32 bits hold all coordinates");
    }
  }
  for (std::size_t first = 0; first < points.size(); first += kAtOnce) {
    sink_->append({part<Point>(points, first), part(mesh_.normals(), first), part(mesh_.values(), first), {}});
  }
  std::vector<std::array<std::uint64_t, 3>> wide;
  for (std::size_t first = 0; first < mesh_.triangles().size(); first += kAtOnce) {
    wide.clear();
    for (const auto& [a, b, c] : part(mesh_.triangles(), first)) {
      wide.push_back({a, b, c});
      digest_ += triangle_digest(points[a], points[b], points[c], offset);
    }
    sink_->append({{}, {}, {}, wide});
  }
  sink_->finish();
}

}  // namespace isoweave
