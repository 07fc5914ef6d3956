#include "volume/grid_coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "files/header_text.hpp"
#include "parallel/size.hpp"
#include "volume/axes.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// Samples in the machine's byte order. Callers read whole samples.
class SwappedStream final : public ByteStream {
 public:
  SwappedStream(std::unique_ptr<ByteStream> samples, std::size_t bytes_each)
      : samples_(std::move(samples)), bytes_each_(bytes_each) {}

  std::size_t read(std::span<std::byte> out) override {
    const std::size_t got = samples_->read(out);
    swap_sample_bytes(out.first(got), bytes_each_);
    return got;
  }
  std::uint64_t skip(std::uint64_t count) override { return samples_->skip(count); }
  bool skips() const override { return samples_->skips(); }

 private:
  std::unique_ptr<ByteStream> samples_;
  std::size_t bytes_each_;
};

// The middles between points. A single point is its own middle.
std::vector<double> middles(const std::vector<double>& points) {
  if (points.size() < 2) return points;
  std::vector<double> places;
  for (std::size_t n = 1; n < points.size(); ++n) places.push_back(std::midpoint(points[n - 1], points[n]));
  return places;
}

// Where a coordinate would lie among even ones.
double place_of(const std::vector<double>& places, std::size_t n) {
  return places.front() + even_step(places) * static_cast<double>(n);
}

// First place and step.
std::pair<double, double> even_axis(const std::vector<double>& places, char axis, const std::string& path) {
  if (const std::optional<std::size_t> n = first_uneven(places)) {
    const double even = place_of(places, *n);
    bad_input(path,
              std::string("evenly spaced ") + axis + " coordinates, " + number_text(even) + " at " + std::to_string(*n),
              number_text(places[*n]));
  }
  return {places.front(), even_step(places)};
}

// Equal places are refused where the distances are looked at.
void refuse_turns(const std::vector<double>& places, bool descend, const std::string& path) {
  for (std::size_t n = 1; n < places.size(); ++n) {
    if (descend ? places[n] <= places[n - 1] : places[n] >= places[n - 1]) continue;
    bad_input(path, "z coordinates that ascend, or descend, from the first to the last",
              number_text(places[n]) + " behind " + number_text(places[n - 1]) + " at " + std::to_string(n));
  }
}

EvenGrid grid_of(VolumeInfo& info, const std::vector<double>& places, bool descend, const OpenOptions& options) {
  SlicePlaces slices{info.path, places, [](std::size_t n) { return "slice " + std::to_string(n); },
                     [path = info.path](std::size_t) { return path; }};
  slices.unit.clear();
  for (double& depth : slices.depths) depth = descend ? -depth : depth;
  std::vector<std::string> notes;
  EvenGrid grid = even_grid(slices, options.spacing ? UnevenSlices::kMean : options.uneven_slices, notes);
  if (options.spacing && !notes.empty()) {
    notes.back() = "the slices do not lie at an even distance: the one that is given is taken for all of them";
  }
  info.notes.insert(info.notes.end(), notes.begin(), notes.end());
  return grid;
}

}  // namespace

std::vector<double> read_coordinates(ByteStream& stream, SampleType type, bool swap_bytes, std::uint64_t count,
                                     const std::string& path) {
  if (count > kMostCoordinates) bad_input(path, "at most 2^24 coordinates", std::to_string(count));
  std::vector<std::byte> bytes(to_size(count, sample_bytes(type)));
  if (stream.read(bytes) < bytes.size()) bad_input(path, "all coordinates", "the end of an array");
  if (swap_bytes) swap_sample_bytes(bytes, sample_bytes(type));
  return numbers_of_samples(bytes, type);
}

double even_step(const std::vector<double>& places) {
  return places.size() < 2 ? 1 : (places.back() - places.front()) / static_cast<double>(places.size() - 1);
}

std::optional<std::size_t> first_uneven(const std::vector<double>& places) {
  const double slack = std::abs(even_step(places)) / 100;
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (!(std::abs(places[n] - place_of(places, n)) <= slack)) return n;
  }
  return std::nullopt;
}

EvenGrid place_on_grid(VolumeInfo& info, const GridCoordinates& points, bool cells, const OpenOptions& options) {
  Axes axes;
  EvenGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char name = static_cast<char>('x' + axis);
    const std::vector<double> places = cells ? middles(points[axis]) : points[axis];
    const bool finite = std::all_of(places.begin(), places.end(), [](double place) { return std::isfinite(place); });
    if (places.empty() || !finite) {
      bad_input(info.path, std::string("finite ") + name + " coordinates", places.empty() ? "none" : "others");
    }
    info.dims[axis] = static_cast<std::int64_t>(places.size());
    if (places.size() == 1) info.notes.push_back(std::string("one ") + name + " coordinate: the spacing there is 1");
    if (axis < 2) {
      std::tie(axes.origin[axis], axes.steps[axis][axis]) = even_axis(places, name, info.path);
      continue;
    }
    const bool descend = places.back() < places.front();
    refuse_turns(places, descend, info.path);
    grid = grid_of(info, places, descend, options);
    axes.origin[axis] = places.front();
    if (places.size() > 1) axes.steps[axis][axis] = descend ? -grid.distance() : grid.distance();
  }
  set_geometry(info.geometry, axes, info.path);
  return grid;
}

void take_even_slices(OpenedVolume& volume, const EvenGrid& grid) {
  if (!grid.is_resampled) return;
  VolumeInfo& info = volume.info;
  if (std::exchange(volume.swap_bytes, false)) {
    volume.samples = std::make_unique<SwappedStream>(std::move(volume.samples), sample_bytes(info.type));
  }
  volume.samples = even_slices(std::move(volume.samples), grid, info.type, info.slice_bytes());
  volume.held_bytes += 3 * info.slice_bytes();
  info.dims[2] = grid.count;
  info.part += (info.part.empty() ? "" : ", ") + std::string("slices made at an even distance");
  checked_volume_bytes(info);
}

}  // namespace isoweave
