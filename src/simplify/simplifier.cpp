#include "simplify/simplifier.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "isoweave/error.hpp"
#include "parallel/collect.hpp"
#include "simplify/hand_over.hpp"
#include "simplify/inspection.hpp"
#include "simplify/local_minima.hpp"
#include "simplify/queue.hpp"
#include "simplify/rounds.hpp"
#include "simplify/turns.hpp"

namespace isoweave {

namespace {

constexpr std::int64_t kSimplifierBlock = 8192;
constexpr std::size_t kTakenAtOnce = 1 << 18;  // final triangles: their copies must not add to the peak of memory

std::unique_ptr<Driver> make_driver(Schedule schedule, Zone& zone, const Executor& executor) {
  switch (schedule) {
    case Schedule::kQueue:
      return std::make_unique<Queue>(zone);
    case Schedule::kRounds:
      return std::make_unique<Rounds>(zone, executor);
    default:
      return std::make_unique<LocalMinima>(zone, executor);
  }
}

}  // namespace

class Simplifier::Source final : public FinalSource {
 public:
  Source(Simplifier& simplifier, std::size_t level, bool cut)
      : simplifier_(simplifier), level_(level), hand_over_(simplifier.zone_, level, cut, simplifier.executor_) {}

  void take_final(const Receipt& first, FinalPiece& piece) override {
    if (!has_more()) list();
    const std::span<const Index> next = std::span(triangles_).subspan(taken_);
    const std::span<const Index> some = next.first(std::min(next.size(), kTakenAtOnce));
    hand_over_.fill(some, first, piece);
    taken_ += some.size();
    if (!has_more() && simplifier_.is_last(level_)) simplifier_.note_dropped(triangles_.size());
  }
  bool has_more() const override { return taken_ < triangles_.size(); }
  std::size_t held_vertices() const override { return simplifier_.zone_.vertices.size(); }
  void change_labels(const std::function<void(std::span<std::uint32_t*>)>& change) override {
    hand_over_.change_labels(change);
  }

 private:
  void list() {
    triangles_ = simplifier_.final_triangles(level_, simplifier_.limit_of(level_));
    taken_ = 0;
  }

  Simplifier& simplifier_;
  const std::size_t level_;
  HandOver hand_over_;
  std::vector<Index> triangles_;  // final ones, of which some have been taken
  std::size_t taken_ = 0;
};

Simplifier::Simplifier(const SimplifierOptions& options, const Executor& executor, const std::atomic<bool>* stop)
    : zone_(options.zone, options.finer.size()),
      executor_(executor),
      stop_(stop),
      schedule_(options.schedule == Schedule::kAutomatic ? Schedule::kLocal : options.schedule),
      finer_(options.finer),
      inspects_(options.inspect),
      driver_(make_driver(schedule_, zone_, executor)),
      defects_(levels()) {
  for (std::size_t level = 0; level < levels(); ++level) {
    sources_.push_back(std::make_unique<Source>(*this, level, options.cut));
  }
}

Simplifier::~Simplifier() = default;

void Simplifier::decide() {
  driver_->run(stop_);
  if (stop_ != nullptr && stop_->load()) throw Interrupted("interrupted, nothing was written");
}

void Simplifier::decide(std::size_t level) {
  if (levels() > 1) zone_.limit = limit_of(level);
  decide();
}

void Simplifier::decide_in_order(std::uint64_t triangles) {
  if (this->triangles() <= triangles) return;
  Queue queue(zone_, this->triangles() - triangles);
  queue.decide(stop_);
  counts_before_ += queue.counts();
  if (stop_ != nullptr && stop_->load()) throw Interrupted("interrupted, nothing was written");
}

ZonePart Simplifier::take_settled(CostHistogram& least) {
  // Triangles of a vertex that was final before may have gone, and with them its least edge.
  std::vector<std::uint8_t> was_final(zone_.vertices.size());
  std::ranges::transform(zone_.states, was_final.begin(),
                         [](VertexState state) { return state == VertexState::kFinal; });
  const std::vector<Index> triangles = final_triangles(finer_.size(), zone_.limit);
  for (const Index t : triangles) {
    const bool known = std::ranges::none_of(zone_.triangles[t].sides,
                                            [&](const HalfEdge& side) { return was_final[side.vertex] != 0; });
    least.add(known ? least_cost(zone_, t) : zone_.limit);
  }
  ZonePart part = zone_.copy_settled(triangles);
  executor_.for_each(static_cast<std::int64_t>(triangles.size()), kSimplifierBlock,
                     [&](std::int64_t n) { zone_.remove_triangle(triangles[static_cast<std::size_t>(n)]); });
  note_dropped(triangles.size());
  return part;
}

// Finds the triangles of a level whose vertices are all final there, in memory order, each once. Makes vertices final:
// those at which all edges cost more than `within`.
std::vector<Index> Simplifier::final_triangles(std::size_t level, CostBits within) {
  const std::vector<Index> vertices = name_final_vertices(level, within);
  std::vector<std::uint32_t> corners(inspects_ ? zone_.vertices.size() : 0, 0);
  std::vector<Index> triangles;
  collect(
      executor_, zone_.triangle_count(), kSimplifierBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        for (auto t = static_cast<Index>(begin); t < static_cast<Index>(end); ++t) {
          if (zone_.triangles[t].sides[0].vertex == kNone) continue;
          int undecided = 0;
          for (const HalfEdge& side : zone_.triangles[t].sides) {
            undecided += undecided_[side.vertex];
            if (undecided_[side.vertex] || !inspects_) continue;
            std::atomic_ref(corners[side.vertex]).fetch_add(1, std::memory_order_relaxed);
          }
          if (undecided == 0 && zone_.triangles[t].levels == level) list.push_back(t);
        }
      },
      triangles);
  if (inspects_) defects_[level] += inspect_fans(zone_, vertices, corners, executor_);
  return triangles;
}

// Makes vertices final in a level. Returns those of them that are inspected, as their star can be walked.
std::vector<Index> Simplifier::name_final_vertices(std::size_t level, CostBits within) {
  undecided_.resize(zone_.vertices.size());
  std::vector<Index> walkable;
  collect(
      executor_, static_cast<std::int64_t>(zone_.vertices.size()), kSimplifierBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          undecided_[v] = zone_.states[v] == VertexState::kIncomplete || cost_of(zone_.turn_keys[v]) <= within;
          if (undecided_[v]) continue;
          if (make_final(v, level) && inspects_ && zone_.walkable(v)) list.push_back(v);
        }
      },
      walkable);
  return walkable;
}

// Makes v final. Returns whether it was not final before. Locked vertices stay locked.
bool Simplifier::make_final(Index v, std::size_t level) {
  if (zone_.states[v] == VertexState::kLocked) return false;
  if (is_last(level)) return std::exchange(zone_.states[v], VertexState::kFinal) != VertexState::kFinal;
  return !std::exchange(zone_.levels[level][v].final, true);
}

// Counts triangles that have been removed from the zone, as they were handed over.
void Simplifier::note_dropped(std::size_t triangles) {
  dropped_ += triangles;
  close_gaps();
}

void Simplifier::close_gaps(std::uint64_t part) {
  const std::uint64_t gone = zone_.triangle_count() - live_triangles();
  if (part * gone >= zone_.triangle_count()) zone_.compact(executor_);
}

CostHistogram Simplifier::removed_by_key() const {
  CostHistogram sum;
  if (removed_before_) sum.merge(*removed_before_);
  driver_->add_removed(sum);
  return sum;
}

void Simplifier::serialize(StateWriter& state) const {
  SimplifierCounts{counts(), rounds(), appended_, dropped_}.serialize(state);
  for (const SurfaceDefects& defects : defects_) state.value(defects);
  zone_.serialize(state);
}

void Simplifier::serialize(StateReader& state, const PartShape& shape) {
  SimplifierCounts saved;
  saved.serialize(state);
  counts_before_ = saved.decisions;
  rounds_before_ = saved.rounds;
  appended_ = saved.appended;
  dropped_ = saved.dropped;
  for (SurfaceDefects& defects : defects_) state.value(defects);
  zone_.serialize(state, shape);
  state.require(saved.held() == zone_.triangle_count(), "as many triangles as are counted");
}

}  // namespace isoweave
