#include "simplify/rounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 1 << 14;

struct Rung {
  double error_fraction;  // of the largest cost
  double side;            // of the cubes, in mean voxels
  double shift;           // of the cuts, in sides
};

constexpr std::array<Rung, 6> kLadder{
    {{1.0 / 1024, 32, 0}, {1.0 / 64, 40, 0.5}, {1.0 / 8, 48, 0.25}, {1.0 / 8, 48, 0.75}, {1, 64, 0}, {1, 64, 0.5}}};

bool is_live(const Zone& zone, Index h, CostBits limit) {
  return zone.alive(h) && zone.cost[h] <= limit && zone.cost[h] != kUnknownCost && zone.represents_edge(h);
}

void set_flag(std::uint8_t& flag) { std::atomic_ref(flag).store(1, std::memory_order_relaxed); }

}  // namespace

void list_live_edges(const Zone& zone, CostBits limit, const Executor& executor, Buckets& out) {
  fill_buckets(
      executor, static_cast<std::uint32_t>(zone.half_edges.size()), 1,
      [&](std::uint32_t h) { return is_live(zone, h, limit) ? std::size_t{0} : std::size_t{1}; }, out);
}

Rounds::Rounds(Zone& zone, Quality quality, const Executor& executor, const RoundsOptions& options)
    : zone_(zone), executor_(executor), options_(options) {
  for (int n = 0; n < executor.threads(); ++n) queues_.push_back(std::make_unique<Queue>(zone, quality));
}

Rounds::~Rounds() = default;

DecisionCounts Rounds::counts() const {
  DecisionCounts sum;
  for (const auto& queue : queues_) sum += queue->counts();
  return sum;
}

void Rounds::run(const std::atomic<bool>* stop) {
  const CostBits retire = zone_.options().retire;
  const double unit = options_.side * std::sqrt(zone_.options().a0);
  list_live_edges(zone_, retire, executor_, parts_);
  if (parts_.items.size() > options_.small_zone) {
    for (const Rung& rung : kLadder) {
      const CostBits limit = to_cost(rung.error_fraction * static_cast<double>(cost_value(retire)));
      round(limit, rung.side * unit, rung.shift * rung.side * unit, stop);
    }
    list_live_edges(zone_, retire, executor_, parts_);
  }
  flags_.assign(zone_.vertices.size(), 0);
  flag_front(zone_, flags_);
  queues_.front()->run(parts_.items, retire, flags_, stop);
  ++rounds_;
}

void Rounds::round(CostBits limit, double side, double shift, const std::atomic<bool>* stop) {
  mark_active(limit);
  const std::size_t parts = assign_parts(side, shift);
  flag_cuts();
  fill_buckets(
      executor_, static_cast<std::uint32_t>(zone_.half_edges.size()), parts,
      [&](std::uint32_t h) {
        if (!is_live(zone_, h, limit)) return parts;
        const std::uint32_t part = part_[zone_.origin(h)];
        return part == part_[zone_.destination(h)] ? std::size_t{part} : parts;
      },
      parts_);
  // Worker n takes the next part that nobody has; which one it is does not matter.
  std::atomic<std::size_t> next_part{0};
  executor_.for_each(executor_.threads(), 1, [&](std::int64_t worker) {
    for (std::size_t part = next_part++; part < parts; part = next_part++) {
      const auto edges =
          std::span(parts_.items).subspan(parts_.start[part], parts_.start[part + 1] - parts_.start[part]);
      if (!edges.empty()) queues_[static_cast<std::size_t>(worker)]->run(edges, limit, flags_, stop);
    }
  });
  ++rounds_;
}

// Vertices with an edge that is live at this level; the others will not move or be looked around.
void Rounds::mark_active(CostBits limit) {
  active_.assign(zone_.vertices.size(), 0);
  executor_.for_each(static_cast<std::int64_t>(zone_.half_edges.size()), kBlock, [&](std::int64_t n) {
    const auto h = static_cast<Index>(n);
    if (!zone_.alive(h) || zone_.cost[h] > limit) return;
    set_flag(active_[zone_.origin(h)]);
    set_flag(active_[zone_.destination(h)]);
  });
}

// Numbers the cubes of the grid and gives every vertex the number of its cube.
std::size_t Rounds::assign_parts(double side, double shift) {
  const std::vector<Vertex>& vertices = zone_.vertices;
  Vec3 low = vertices.front().position;
  Vec3 high = low;
  for (const Vertex& vertex : vertices) {
    low = {std::min(low.x, vertex.position.x), std::min(low.y, vertex.position.y), std::min(low.z, vertex.position.z)};
    high = {std::max(high.x, vertex.position.x), std::max(high.y, vertex.position.y),
            std::max(high.z, vertex.position.z)};
  }
  const auto cell = [&](double p, double from) { return static_cast<std::uint32_t>((p - from + shift) / side); };
  const std::uint32_t nx = cell(high.x, low.x) + 1;
  const std::uint32_t ny = cell(high.y, low.y) + 1;
  const std::uint32_t nz = cell(high.z, low.z) + 1;
  part_.resize(vertices.size());
  executor_.for_each(static_cast<std::int64_t>(vertices.size()), kBlock, [&](std::int64_t n) {
    const Vec3 p = vertices[static_cast<std::size_t>(n)].position;
    part_[static_cast<std::size_t>(n)] = cell(p.x, low.x) + nx * (cell(p.y, low.y) + ny * cell(p.z, low.z));
  });
  return std::size_t{nx} * ny * nz;
}

// Flags both ends of every edge between two active vertices of different parts, retired edges included: the edges at
// either end conflict through it. And both ends of the edges whose keys are not known yet.
void Rounds::flag_cuts() {
  flags_.assign(zone_.vertices.size(), 0);
  executor_.for_each(static_cast<std::int64_t>(zone_.half_edges.size()), kBlock, [&](std::int64_t n) {
    const auto h = static_cast<Index>(n);
    if (!zone_.alive(h)) return;
    const Index a = zone_.origin(h);
    const Index b = zone_.destination(h);
    const bool cut = part_[a] != part_[b] && active_[a] && active_[b];
    if (!cut && zone_.cost[h] != kUnknownCost) return;
    set_flag(flags_[a]);
    set_flag(flags_[b]);
  });
}

}  // namespace isoweave
