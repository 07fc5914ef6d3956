#include "volume/fields.hpp"

#include <algorithm>
#include <cmath>

#include "volume/noise.hpp"

namespace isoweave {
namespace {

using Dims = std::array<std::int64_t, 3>;

double centre_of(std::int64_t side) { return 0.5 * (static_cast<double>(side) - 1); }

// Squared distances of the samples of a row from the centre, in steps of one sample.
class CentredField : public Field {
 public:
  explicit CentredField(const Dims& dims) : centre_{centre_of(dims[0]), centre_of(dims[1]), centre_of(dims[2])} {}

 protected:
  double offset(std::size_t axis, std::int64_t at) const { return static_cast<double>(at) - centre_[axis]; }

  std::array<double, 3> centre_;
};

class SphereField final : public CentredField {
 public:
  explicit SphereField(const Dims& dims)
      : CentredField(dims), radius_(0.4 * static_cast<double>(std::min({dims[0], dims[1], dims[2]}))) {}

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    const double y = offset(1, j);
    const double z = offset(2, k);
    const double rest = y * y + z * z;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double x = offset(0, first + static_cast<std::int64_t>(i));
      row[i] = radius_ - std::sqrt(x * x + rest);
    }
  }

 private:
  double radius_;
};

class TorusField final : public CentredField {
 public:
  explicit TorusField(const Dims& dims) : CentredField(dims) {
    const auto width = static_cast<double>(std::min(dims[0], dims[1]));
    ring_ = 0.29 * width;
    tube_ = std::min(0.12 * width, 0.4 * static_cast<double>(dims[2]));
  }

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    const double y = offset(1, j);
    const double z = offset(2, k);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double x = offset(0, first + static_cast<std::int64_t>(i));
      const double from_ring = std::sqrt(x * x + y * y) - ring_;
      row[i] = tube_ - std::sqrt(from_ring * from_ring + z * z);
    }
  }

 private:
  double ring_;
  double tube_;
};

// sin(2 pi turns) for turns in [0, 1): the Taylor series about 0, after folding to a quarter turn. The library's sine
// differs from machine to machine.
double sine_of_turns(double turns) {
  if (turns > 0.75) turns -= 1;
  if (turns > 0.25) turns = 0.5 - turns;
  constexpr double kTwoPi = 6.283185307179586;
  const double x = kTwoPi * turns;
  double term = x;
  double sum = x;
  for (int n = 2; n <= 20; n += 2) {
    term = -term * x * x / static_cast<double>(n * (n + 1));
    sum += term;
  }
  return sum;
}

class GyroidField final : public Field {
 public:
  GyroidField() {
    // Phases off the lattice, and different, so that no sample is 0 and no two axes look alike.
    constexpr std::array<double, 3> kPhases{0.37, 0.61, 0.23};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t n = 0; n < kPeriod; ++n) {
        const double turns = (static_cast<double>(n) + kPhases[axis]) / kPeriod;
        sine_[axis][n] = sine_of_turns(turns);
        cosine_[axis][n] = sine_of_turns(turns + 0.25 >= 1 ? turns - 0.75 : turns + 0.25);
      }
    }
  }

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    const std::size_t y = static_cast<std::size_t>(j) % kPeriod;
    const std::size_t z = static_cast<std::size_t>(k) % kPeriod;
    std::array<double, kPeriod> wave;
    for (std::size_t x = 0; x < kPeriod; ++x) {
      wave[x] = sine_[0][x] * cosine_[1][y] + sine_[1][y] * cosine_[2][z] + sine_[2][z] * cosine_[0][x];
    }
    const auto from = static_cast<std::size_t>(first);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = wave[(from + i) % kPeriod];
  }

 private:
  static constexpr std::size_t kPeriod = 32;
  std::array<std::array<double, kPeriod>, 3> sine_;
  std::array<std::array<double, kPeriod>, 3> cosine_;
};

// Distance to the nearest face plane of a box, positive inside.
class BoxField final : public Field {
 public:
  explicit BoxField(const Dims& dims) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Fifths of a whole number and these offsets never add up to a whole number.
      low_[axis] = 0.2 * static_cast<double>(dims[axis]) + 0.37;
      high_[axis] = 0.8 * static_cast<double>(dims[axis]) - 0.41;
    }
  }

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    const double rest = std::min(depth(1, static_cast<double>(j)), depth(2, static_cast<double>(k)));
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = std::min(rest, depth(0, static_cast<double>(first + static_cast<std::int64_t>(i))));
    }
  }

 private:
  double depth(std::size_t axis, double at) const { return std::min(at - low_[axis], high_[axis] - at); }

  std::array<double, 3> low_;
  std::array<double, 3> high_;
};

// A triangle wave of the distance from the centre: 0 at every odd distance.
class ShellsField final : public CentredField {
 public:
  explicit ShellsField(const Dims& dims) : CentredField(dims) {}

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    const double y = offset(1, j);
    const double z = offset(2, k);
    const double rest = y * y + z * z;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double x = offset(0, first + static_cast<std::int64_t>(i));
      const double distance = std::sqrt(x * x + rest);
      row[i] = 1 - std::abs(distance - 4 * std::floor(distance * 0.25) - 2);
    }
  }
};

// Two octaves of value noise, and where `roughness` is not 0 white noise on top.
class NoiseField final : public Field {
 public:
  NoiseField(std::uint64_t seed, double roughness)
      : coarse_(12, seed), fine_(6, seed), seed_(seed), roughness_(roughness) {}

  void begin_slice(std::int64_t k) override {
    coarse_.begin_slice(k);
    fine_.begin_slice(k);
  }

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    std::fill(row.begin(), row.end(), 0.0);
    coarse_.add_row(j, first, 0.75, row);
    fine_.add_row(j, first, 0.25, row);
    if (roughness_ > 0) roughen(row_bits(seed_, j, k) + static_cast<std::uint64_t>(first), row);
  }

 private:
  void roughen(std::uint64_t bits, std::span<double> row) const {
    for (std::size_t i = 0; i < row.size(); ++i) row[i] += roughness_ * (unit_value(scramble_bits(bits + i)) - 0.5);
  }

  ValueNoise coarse_;
  ValueNoise fine_;
  std::uint64_t seed_;
  double roughness_;
};

class WhiteField final : public Field {
 public:
  explicit WhiteField(std::uint64_t seed) : seed_(seed) {}

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    const std::uint64_t bits = row_bits(seed_, j, k) + static_cast<std::uint64_t>(first);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = unit_value(scramble_bits(bits + i));
  }

 private:
  std::uint64_t seed_;
};

// One speck in about half of the blocks of 4 x 4 x 4 samples, never in the last layer of a block on any axis: two
// specks are at least two samples apart.
class SpecksField final : public Field {
 public:
  explicit SpecksField(std::uint64_t seed) : seed_(seed) {}

  void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) override {
    std::fill(row.begin(), row.end(), 0.0);
    const std::uint64_t blocks = row_bits(seed_, j / kBlock, k / kBlock);
    const std::int64_t end = first + static_cast<std::int64_t>(row.size());
    for (std::int64_t block = first / kBlock; block * kBlock < end; ++block) {
      const std::uint64_t bits = scramble_bits(blocks + static_cast<std::uint64_t>(block));
      const bool here = (bits >> 60) < 8 && place(bits, 8) == j % kBlock && place(bits, 16) == k % kBlock;
      const std::int64_t i = block * kBlock + place(bits, 0);
      if (here && i >= first && i < end) row[static_cast<std::size_t>(i - first)] = 1;
    }
  }

 private:
  static constexpr std::int64_t kBlock = 4;
  static std::int64_t place(std::uint64_t bits, int shift) {
    return static_cast<std::int64_t>(((bits >> shift) & 0xff) % (kBlock - 1));
  }

  std::uint64_t seed_;
};

template <class Formula>
std::unique_ptr<Field> make_of_dims(const Dims& dims, std::uint64_t) {
  return std::make_unique<Formula>(dims);
}

template <class Formula>
std::unique_ptr<Field> make_of_seed(const Dims&, std::uint64_t seed) {
  return std::make_unique<Formula>(seed);
}

std::unique_ptr<Field> make_gyroid(const Dims&, std::uint64_t) { return std::make_unique<GyroidField>(); }

std::unique_ptr<Field> make_smooth(const Dims&, std::uint64_t seed) { return std::make_unique<NoiseField>(seed, 0.0); }

std::unique_ptr<Field> make_noise(const Dims&, std::uint64_t seed) {
  constexpr double kRoughness = 0.2;
  return std::make_unique<NoiseField>(seed, kRoughness);
}

// Distances are shown 16 samples to each side of the surface, whatever the dims, so that one iso-value fits all.
constexpr std::array<FieldKind, 9> kKinds{{{"sphere", 0, -16, 16, make_of_dims<SphereField>},
                                           {"torus", 0, -16, 16, make_of_dims<TorusField>},
                                           {"gyroid", 0, -1.5, 1.5, make_gyroid},
                                           {"box", 0, -16, 16, make_of_dims<BoxField>},
                                           {"shells", 0, -1, 1, make_of_dims<ShellsField>},
                                           {"smooth", 0.5, 0, 1, make_smooth},
                                           {"noise", 0.5, 0, 1, make_noise},
                                           {"white", 0.5, 0, 1, make_of_seed<WhiteField>},
                                           {"specks", 0.5, 0, 1, make_of_seed<SpecksField>}}};

}  // namespace

std::span<const FieldKind> field_kinds() { return kKinds; }

}  // namespace isoweave
