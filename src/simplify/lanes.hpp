// N doubles that go through the same arithmetic. Every lane gets the bits that a double would get: nothing is
// contracted, reordered or approximated, so results do not depend on N.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace isoweave {

// The types of vectors, by the number of their lanes: compilers ignore the attributes where these depend on a
// template's argument.
template <std::size_t N>
struct LaneTypes;

template <>
struct LaneTypes<2> {
  using Vector [[gnu::vector_size(16)]] = double;
  using Mask [[gnu::vector_size(16)]] = std::int64_t;
  using InMemory [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
  using Integers [[gnu::vector_size(16)]] = std::int32_t;
  using IntegersInMemory [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = std::int32_t;
};

template <>
struct LaneTypes<4> {
  using Vector [[gnu::vector_size(32)]] = double;
  using Mask [[gnu::vector_size(32)]] = std::int64_t;
  using InMemory [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
  using Integers [[gnu::vector_size(32)]] = std::int32_t;
  using IntegersInMemory [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = std::int32_t;
};

template <>
struct LaneTypes<8> {
  using Vector [[gnu::vector_size(64)]] = double;
  using Mask [[gnu::vector_size(64)]] = std::int64_t;
  using InMemory [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;
  using Integers [[gnu::vector_size(64)]] = std::int32_t;
  using IntegersInMemory [[gnu::vector_size(64), gnu::aligned(4), gnu::may_alias]] = std::int32_t;
};

template <std::size_t N>
struct Lanes {
  using Vector = typename LaneTypes<N>::Vector;
  using Mask = typename LaneTypes<N>::Mask;
  using InMemory = typename LaneTypes<N>::InMemory;

  Vector v;

  Lanes() = default;
  Lanes(Vector vector) : v(vector) {}
  Lanes(double value) : v(value - Vector{}) {}

  static Lanes load(const double* from) { return {*reinterpret_cast<const InMemory*>(from)}; }
  void store(double* to) const { *reinterpret_cast<InMemory*>(to) = v; }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return a.v + b.v; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return a.v - b.v; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return a.v * b.v; }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return a.v / b.v; }
  friend Lanes operator-(const Lanes& a) { return -a.v; }
  friend Mask operator>(const Lanes& a, const Lanes& b) { return a.v > b.v; }
  friend Mask operator>=(const Lanes& a, const Lanes& b) { return a.v >= b.v; }
};

// Calls body(n) with the constants n = 0...N - 1.
template <std::size_t N, class Body>
[[gnu::always_inline]] inline void unrolled(const Body& body) {
  [&]<std::size_t... I>(std::index_sequence<I...>) { (body(std::integral_constant<std::size_t, I>()), ...); }
  (std::make_index_sequence<N>());
}

template <std::size_t N>
Lanes<N> square_root(const Lanes<N>& a) {
  double values[N];
  a.store(values);
  for (double& value : values) value = std::sqrt(value);
  return Lanes<N>::load(values);
}

template <std::size_t N>
Lanes<N> select(typename Lanes<N>::Mask mask, const Lanes<N>& a, const Lanes<N>& b) {
  return {mask ? a.v : b.v};
}

template <std::size_t N>
bool all(typename Lanes<N>::Mask mask) {
  std::int64_t both = -1;
  unrolled<N>([&](auto n) { both &= mask[n.value]; });
  return both != 0;
}

// All lanes of a but the first, then the first lane of b.
template <std::size_t N>
[[gnu::always_inline]] inline Lanes<N> shifted(const Lanes<N>& a, const Lanes<N>& b) {
  return [&]<std::size_t... Lane>(std::index_sequence<Lane...>) {
    return Lanes<N>(__builtin_shufflevector(a.v, b.v, (Lane + 1)...));
  }
  (std::make_index_sequence<N>());
}

// Transposes every group of W lanes: in steps, blocks of half the size change places across the diagonal.
template <std::size_t N, std::size_t W>
[[gnu::always_inline]] inline void transpose(Lanes<N> (&rows)[W]) {
  const auto exchange = [&]<std::size_t... Lane>(auto half, std::index_sequence<Lane...>) {
    unrolled<W>([&](auto n) {
      if constexpr ((n & half) == 0) {
        const auto a = rows[n].v;
        const auto b = rows[n + half].v;
        rows[n].v = __builtin_shufflevector(a, b, ((Lane & half) == 0 ? Lane : N + Lane - half)...);
        rows[n + half].v = __builtin_shufflevector(a, b, ((Lane & half) == 0 ? Lane + half : N + Lane)...);
      }
    });
  };
  constexpr auto kAll = std::make_index_sequence<N>();
  if constexpr (W > 4) exchange(std::integral_constant<std::size_t, 4>(), kAll);
  if constexpr (W > 2) exchange(std::integral_constant<std::size_t, 2>(), kAll);
  exchange(std::integral_constant<std::size_t, 1>(), kAll);
}

// Loads W doubles from each of `Count` places: from[row], from[row + W], ...
template <std::size_t W, std::size_t Count>
[[gnu::always_inline]] inline auto load_rows(const double* const* from, std::size_t row, std::size_t offset) {
  if constexpr (Count == 1) {
    return Lanes<W>::load(from[row] + offset).v;
  } else {
    const auto a = load_rows<W, Count / 2>(from, row, offset);
    const auto b = load_rows<W, Count / 2>(from, row + W * Count / 2, offset);
    return [&]<std::size_t... Lane>(std::index_sequence<Lane...>) { return __builtin_shufflevector(a, b, Lane...); }
    (std::make_index_sequence<W * Count>());
  }
}

// Loads the W doubles that lie `offset` doubles after each of N places, by columns. Reads nothing else.
template <std::size_t W, std::size_t N>
[[gnu::always_inline]] inline void load_columns(const double* const (&from)[N], std::size_t offset, Lanes<N>* columns) {
  Lanes<N> rows[W];
  unrolled<W>([&](auto n) { rows[n] = Lanes<N>(load_rows<W, N / W>(from, n, offset)); });
  transpose<N, W>(rows);
  unrolled<W>([&](auto n) { columns[n] = rows[n]; });
}

}  // namespace isoweave
