// The formulas of the generated volumes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace isoweave {

// A scalar field over the sample lattice, computed row by row.
class Field {
 public:
  virtual ~Field() = default;
  virtual void begin_slice(std::int64_t) {}
  // Fills samples of row j of slice k, from sample `first` on. begin_slice was called for that slice last.
  virtual void fill_row(std::int64_t j, std::int64_t k, std::int64_t first, std::span<double> row) = 0;
};

struct FieldKind {
  std::string_view name;
  double iso;
  double low;  // integer samples show [low, high] as 0...255
  double high;
  std::unique_ptr<Field> (*make)(const std::array<std::int64_t, 3>& dims, std::uint64_t seed);
};

// In the order of generate.hpp.
std::span<const FieldKind> field_kinds();

}  // namespace isoweave
