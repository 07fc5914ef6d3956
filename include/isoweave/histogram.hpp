// The distribution of a volume's values, and an iso-value from it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "isoweave/label.hpp"
#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// The distribution of the values of a volume: slope and intercept are applied. Infinities are counted, but lie outside
// the range.
struct Histogram {
  static constexpr std::size_t kBins = 256;

  double min = 1;  // of the finite values; min > max when there are none
  double max = 0;
  std::uint64_t nan = 0;                      // samples
  std::uint64_t infinite = 0;                 // samples
  std::optional<std::array<Label, 2>> whole;  // min and max without rounding, of integers of 64 bits without a scaling
  std::array<std::uint64_t, kBins> bins{};    // samples in equal parts of [min, max], the last one closed

  bool empty() const { return min > max; }
};

// Reads the whole volume once, some rows at a time. Nothing is read where all samples are known to be one value.
// @pre The volume has not been read.
// @throws Interrupted when `stop` is set, and what the source throws
// @cost Memory: about 4 MB, or a slice where the source has no rows.
// @determinism Depends on the samples only.
Histogram read_histogram(SliceSource& volume, const std::atomic<bool>* stop = nullptr);

// Otsu's threshold: the value that splits the histogram into the two classes with the largest variance between them
// (Otsu, "A threshold selection method from gray-level histograms", 1979); the middle one of equally good values. As an
// iso-value it parts bright from dark. Nothing when there are not two different values.
std::optional<double> otsu_threshold(const Histogram& histogram);

// The values that split the histogram into `classes` classes with the largest variance between them, ascending (Otsu's
// criterion for several thresholds, found exactly). Fewer where there are not so many different values.
// @throws std::invalid_argument unless classes is from 2 to 8
// @cost classes * kBins^2 steps.
std::vector<double> otsu_thresholds(const Histogram& histogram, std::size_t classes);

// A tissue in CT, by the iso-value in Hounsfield units that parts it from what is around it.
struct HounsfieldPreset {
  std::string_view name;
  double iso;
};

// bone, skin and lung. The surface of the lungs is that of the air in them: inside is below.
std::span<const HounsfieldPreset> hounsfield_presets();

// Whether a range of values looks like that of CT in Hounsfield units: air, far below 0, and what is denser than water.
bool is_hounsfield_range(double min, double max);

// The counts of the histogram in fewer equal parts of its range.
// @throws std::invalid_argument unless `parts` divides kBins
std::vector<std::uint64_t> coarser_bins(const Histogram& histogram, std::size_t parts);

// The edges of the lattice that the surface crosses, for iso-values over the range of a volume: the vertices that a run
// extracts (MeshReport::vertices_extracted). A closed surface has two triangles for each, less twice its Euler number.
struct CrossingCounts {
  Histogram histogram;                // from the same pass
  double first = 0, step = 1;         // iso-values: first + n * step
  std::vector<std::uint64_t> counts;  // exact at these values; empty where all samples are one value
};

// Counts crossings for all iso-values in one pass over the volume. Integers of 8 and 16 bits get each value that a
// sample can have, others up to 512 values at distances of a power of two, all times the slope.
// @pre The volume has not been read.
// @throws Interrupted when `stop` is set, and what the source throws
// @cost Memory: two slices and about 4 MB.
// @determinism Depends on the samples only.
CrossingCounts count_crossings(SliceSource& volume, bool closed = true, bool inside_above = true,
                               const std::atomic<bool>* stop = nullptr);

}  // namespace isoweave
#pragma GCC visibility pop
