#include "simplify/local_minima.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <thread>

#include "parallel/collect.hpp"
#include "parallel/prefetch.hpp"
#include "simplify/columns.hpp"
#include "simplify/turns.hpp"
#include "simplify/work_pool.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kPlaces = Columns::kCount;
constexpr std::uint32_t kNowhere = 2 * kPlaces;

}  // namespace

// Consecutive columns, whose vertices lie near each other.
struct LocalMinima::Stretch {
  std::atomic<std::size_t> next{0};
  std::size_t end = 0;
};

// Serves pairs. A worker holds both ends of the pair that it looks at, all their neighbours when it decides the edge,
// and the vertex that it lets the pair wait for. A worker that holds a vertex never waits for another worker.
class LocalMinima::Worker {
 public:
  Worker(Zone& zone, std::uint16_t number) : zone_(zone), decider_(zone), number_(number) {}

  const DecisionCounts& counts() const { return decider_.counts(); }
  RemovedByKey& removed_by_key() { return removed_by_key_; }

  // owners: nullptr when there is only this worker.
  void begin(std::vector<std::uint16_t>* owners, WorkPool& pool) {
    owners_ = owners;
    pool_ = &pool;
  }

  // Gives keys to the edges of new triangles and turns to the vertices that have all their keys now, and serves the
  // pairs that this makes.
  void settle(TriangleRange range, const std::atomic<bool>* stop) {
    zone_.settle_edges(range, unkeyed_);
    for (Index t = range.begin; t < range.end; ++t) {
      for (const HalfEdge& side : zone_.triangles[t].sides) {
        if (zone_.countdown.count_off(side.vertex, t)) begin_turns(side.vertex);
      }
    }
    serve_all(stop);
  }

  // The edges that got no keys, as an end of them is incomplete.
  std::vector<Index>& unkeyed() { return unkeyed_; }

  // Serves the pair that v belongs to and all pairs that this wakes.
  void serve(Index v, const std::atomic<bool>* stop) {
    todo_.push_back(v);
    serve_all(stop);
  }

  // Serves the pairs that other workers leave, until no worker has any.
  void help(const std::atomic<bool>* stop) {
    while (pool_->take(todo_)) serve_all(stop);
  }

 private:
  static constexpr std::size_t kMuch = 16;

  void serve_all(const std::atomic<bool>* stop) {
    while (!todo_.empty() || !later_.empty()) {
      if (todo_.size() >= kMuch && pool_->wanted()) pool_->give(todo_);
      if (todo_.empty()) {
        todo_.swap(later_);
        std::this_thread::yield();
      }
      const Index top = todo_.back();
      todo_.pop_back();
      if (!visit(top)) later_.push_back(top);
      release();
      if (pool_->failed() || (stop != nullptr && stop->load(std::memory_order_relaxed))) {
        todo_.clear();
        later_.clear();
        return;
      }
    }
  }

  bool hold(Index v) {
    if (owners_ == nullptr) return true;
    const std::atomic_ref<std::uint16_t> owner((*owners_)[v]);
    std::uint16_t found = owner.load(std::memory_order_relaxed);  // a load first: an exchange takes longer
    if (found != 0) return found == number_;
    const bool is_free =
        owner.compare_exchange_strong(found, number_, std::memory_order_acquire, std::memory_order_relaxed);
    if (is_free) held_.push_back(v);
    return is_free;
  }

  void release() {
    for (const Index v : held_) {
      std::atomic_ref<std::uint16_t>((*owners_)[v]).store(0, std::memory_order_release);
    }
    held_.clear();
  }

  // Fetches what a decision reads of the neighbours.
  void prefetch_neighbours(const Star& star) const {
    for (std::size_t n = 0; n < star.count(); ++n) prefetch(&zone_.vertices[star.neighbour[n]]);
  }

  // Puts the pair of v on the stack, and fetches what a look at it begins with.
  void push(Index v) {
    const Index edge = zone_.turns[v].edge;
    if (exists(edge)) prefetch(&zone_.triangles[edge >> 2]);
    prefetch(&zone_.vertices[v]);
    todo_.push_back(v);
  }

  std::atomic_ref<Index> waits_for(Index v) { return std::atomic_ref<Index>(zone_.turns[v].waits_for); }

  // If v is an end of a pair: decides its edge where that is a local minimum, else lets the pair wait for a vertex
  // whose turn comes earlier. Returns false, and does nothing, when another worker holds a vertex that is needed.
  bool visit(Index v) {
    if (!hold(v)) return false;
    if (!has_turn(zone_, v)) return true;
    const Index edge = zone_.turns[v].edge;
    const Index other = other_end(zone_, edge, v);
    if (!hold(other)) return false;
    if (!same_turn(zone_, v, other)) return true;
    const Index pair = std::min(v, other);
    if (waits_for(pair).load(std::memory_order_acquire) != kNone) return true;
    Index before = v;
    decider_.look_at(edge, [&](const Star& star) {
      before = hold_for(star, v);
      if (before == v) prefetch_neighbours(star);
      return before == v;
    });
    if (before == kNone) return false;
    if (before != v) {
      wait(pair, before);
      return true;
    }
    removed_by_key_.around(cost_of(zone_.turn_keys[v]), counts(), [&] { decider_.decide(); });
    settle();
    return true;
  }

  // Looks around one end of the pair of v. Returns a neighbour whose turn comes before that of the pair, and holds it.
  // Returns v if there is no such neighbour, and holds all neighbours. Returns kNone if another worker holds one of
  // them. Half of all looks end at the first end of the pair, and hold no neighbours.
  Index hold_for(const Star& star, Index v) {
    const auto [seen, tied] = last_before(star, v);
    if (seen != v) return hold(seen) && turn_key(seen) < turn_key(v) ? seen : kNone;
    if (owners_ == nullptr) return tied ? earliest_in_full(star, v) : v;
    if (!star.each_neighbour(zone_, [&](Index x) { return hold(x); })) return kNone;
    const auto [last, tied_still] = last_before(star, v);
    return tied_still ? earliest_in_full(star, v) : last;
  }

  // The key of v's turn. It may be an old one unless this worker holds v.
  Key turn_key(Index v) const { return std::atomic_ref(zone_.turn_keys[v]).load(std::memory_order_relaxed); }

  struct Before {
    Index last;
    bool tied;
  };

  // Finds, around one end of the pair of v, the last neighbour among those whose turns come before that of the pair:
  // the others are likely to be served before it is. Gives v if there is no such neighbour. The other end of the pair
  // has the pair's key. If a second neighbour has that key as well, whole ties have to be compared.
  Before last_before(const Star& star, Index v) const {
    const Key own = turn_key(v);
    Key latest = 0;
    Index last = v;
    std::size_t equals = star.overflow ? 2 : 0;
    for (std::size_t n = 0; n < star.count(); ++n) {
      const Index x = star.neighbour[n];
      const Key key = turn_key(x);
      const Key rank = key - 1;  // an unknown turn, 0, counts as the last
      const bool later = (key < own) & (rank >= latest);
      last = later ? x : last;
      latest = later ? rank : latest;
      equals += key == own ? 1 : 0;
    }
    return {last, equals > 1};
  }

  Index earliest_in_full(const Star& star, Index v) const {
    Index first = v;
    star.each_neighbour(zone_, [&](Index x) {
      if (earlier(zone_, x, first)) first = x;
      return true;
    });
    return first;
  }

  void wait(Index pair, Index before) {
    Turn& turn = zone_.turns[pair];
    turn.next_waiter = zone_.turns[before].first_waiter;
    zone_.turns[before].first_waiter = pair;
    waits_for(pair).store(before, std::memory_order_release);
  }

  // Wakes the pairs that v's turn no longer comes before; the others keep waiting for v. The turn of a waiting pair
  // does not change.
  void wake_waiters(Index v) {
    Index kept = kNone;
    for (Index w = zone_.turns[v].first_waiter; w != kNone;) {
      Turn& waiter = zone_.turns[w];
      const Index after = waiter.next_waiter;
      if (zone_.turn_keys[v] < std::atomic_ref(zone_.turn_keys[w]).load(std::memory_order_relaxed)) {
        waiter.next_waiter = kept;
        kept = w;
      } else {
        waits_for(w).store(kNone, std::memory_order_release);
        push(w);
      }
      w = after;
    }
    zone_.turns[v].first_waiter = kept;
  }

  // Gives new turns to the vertices whose least edge has changed. This worker holds all of them.
  void settle() {
    const Star& first = decider_.first();
    const Star& second = decider_.second();
    if (decider_.deferred()) return;  // the pairs that wait for these vertices keep waiting
    if (decider_.vanished()) {
      end_turns(first.vertex);
      for (std::size_t n = 0; n < 3; ++n) end_turns(first.neighbour[n]);
      return;
    }
    if (!decider_.collapsed()) {
      renew_turn(zone_, first);
      renew_turn(zone_, second);
      follow(second.vertex);
      follow(first.vertex);
      return;
    }
    end_turns(second.vertex);
    renew_turn(zone_, decider_.merged());
    follow(first.vertex);
    // Neighbours whose turn was an edge to a merged vertex have another key now.
    for (int n = 0; n < decider_.changed_count(); ++n) {
      const auto place = static_cast<std::size_t>(n);
      const Index w = decider_.changed_end(place);
      if (zone_.turn_keys[w] != decider_.key_before(place)) continue;
      if (!exists(zone_.vertices[w].half_edge)) continue;  // w is beyond the limit, and has lost triangles
      renew_turn(zone_, w);
      follow(w);
    }
  }

  // Gives a vertex its first turn, unless it is incomplete. Another worker may hold the vertex, to let a pair wait for
  // it.
  void begin_turns(Index v) {
    if (zone_.states[v] == VertexState::kIncomplete) return;
    while (!hold(v)) {
      if (pool_->failed()) return;
      std::this_thread::yield();
    }
    give_turn(zone_, v);
    follow(v);
    release();
  }

  void end_turns(Index gone) {
    std::atomic_ref(zone_.turn_keys[gone]).store(kNoTurn, std::memory_order_relaxed);
    zone_.turns[gone].edge = kNone;
    wake_waiters(gone);
  }

  // Acts on v's new turn. If the other end of that edge has the same turn, the two are a pair. Both ends may get their
  // turns at the same time from two workers: each worker stores its turn before it reads the other one, so at least one
  // of them sees the pair.
  void follow(Index v) {
    wake_waiters(v);
    if (!has_turn(zone_, v)) return;
    const Index other = other_end(zone_, zone_.turns[v].edge, v);
    if (std::atomic_ref(zone_.turn_keys[other]).load(std::memory_order_seq_cst) == zone_.turn_keys[v]) {
      push(v);
    }
  }

  Zone& zone_;
  Decider decider_;
  std::uint16_t number_;
  std::vector<std::uint16_t>* owners_ = nullptr;
  WorkPool* pool_ = nullptr;
  std::vector<Index> todo_;   // a stack: the vertex woken last lies nearest
  std::vector<Index> later_;  // vertices to be tried again: another worker held one of their stars
  std::vector<Index> held_;
  std::vector<Index> unkeyed_;
  RemovedByKey removed_by_key_;
};

LocalMinima::LocalMinima(Zone& zone, const Executor& executor) : zone_(zone), executor_(executor) {
  for (int n = 0; n < executor.threads(); ++n) {
    workers_.push_back(std::make_unique<Worker>(zone, static_cast<std::uint16_t>(n + 1)));
  }
}

LocalMinima::~LocalMinima() = default;

DecisionCounts LocalMinima::counts() const {
  DecisionCounts sum;
  for (const auto& worker : workers_) sum += worker->counts();
  return sum;
}

void LocalMinima::count_removed() {
  for (const auto& worker : workers_) worker->removed_by_key().begin();
}

void LocalMinima::add_removed(CostHistogram& sum) const {
  for (const auto& worker : workers_) worker->removed_by_key().add_to(sum);
}

void LocalMinima::run(const std::atomic<bool>* stop) {
  zone_.settle_waiting_edges(executor_);
  give_turns_to_old();
  list_let_through();
  wake_waiters_of_settled();
  group_by_place();
  const bool alone = workers_.size() == 1;
  if (!alone) owners_.assign(zone_.vertices.size(), 0);
  std::vector<Stretch> stretches(workers_.size());
  share_places(stretches);
  WorkPool pool;
  executor_.for_each(executor_.threads(), 1, [&](std::int64_t n) {
    const auto number = static_cast<std::size_t>(n);
    Worker& worker = *workers_[number];
    worker.begin(alone ? nullptr : &owners_, pool);
    const WorkingTime working(pool);
    for (std::size_t m = 0; m < stretches.size(); ++m) {
      Stretch& stretch = stretches[(number + m) % stretches.size()];
      for (std::size_t place = stretch.next++; place < stretch.end && !pool.failed(); place = stretch.next++) {
        worker.settle(zone_.unsettled(place), stop);
        serve_place(place, worker, stop);
      }
    }
    worker.help(stop);
  });
  std::vector<Index> unkeyed;
  for (const auto& worker : workers_) {
    unkeyed.insert(unkeyed.end(), worker->unkeyed().begin(), worker->unkeyed().end());
    worker->unkeyed().clear();
  }
  zone_.set_aside(unkeyed);
  zone_.settled.clear();
  limit_ = zone_.limit;
  ++rounds_;
}

// Gives turns to the settled vertices that are older than the last piece. Those of them at new triangles get their
// turns when the edges of these triangles get their keys.
void LocalMinima::give_turns_to_old() {
  const std::span<const Index> old = zone_.settled.old;
  executor_.for_each(static_cast<std::int64_t>(old.size()), 4096, [&](std::int64_t n) {
    const Index v = old[static_cast<std::size_t>(n)];
    if (zone_.countdown.waits(v)) {
      zone_.turn_keys[v] = kUnknownTurn;
    } else {
      give_turn(zone_, v);
    }
  });
}

// Gives every worker a stretch of columns to begin with, so that workers seldom meet and share few lines of memory.
void LocalMinima::share_places(std::span<Stretch> stretches) const {
  const auto work_before = [&](std::size_t place) { return zone_.unsettled(place).begin + places_.start[place]; };
  const std::size_t all = zone_.unsettled(kPlaces - 1).end - zone_.unsettled(0).begin + places_.items.size();
  std::size_t place = 0;
  for (std::size_t n = 0; n < stretches.size(); ++n) {
    stretches[n].next = place;
    while (place < kPlaces && (work_before(place) - work_before(0)) * stretches.size() < all * (n + 1)) ++place;
    stretches[n].end = place;
  }
}

// Fetches the memory around a vertex.
void LocalMinima::fetch_around(std::uint32_t n) const {
  prefetch(&zone_.vertices[awake(n)]);
  prefetch(&zone_.turns[awake(n)]);
  prefetch(zone_.triangles.data() + triangle_[n]);
  prefetch(zone_.triangles.data() + triangle_[n] + 1);
}

// Serves the pairs of a column.
void LocalMinima::serve_place(std::size_t place, Worker& worker, const std::atomic<bool>* stop) const {
  const auto items =
      std::span(places_.items).subspan(places_.start[place], places_.start[place + 1] - places_.start[place]);
  constexpr std::size_t kAhead = 128;  // vertices fetched ahead: their surroundings fit a cache
  for (std::size_t begin = 0; begin < items.size(); begin += kAhead) {
    const auto next = items.subspan(begin, std::min(kAhead, items.size() - begin));
    for (const std::uint32_t n : next) fetch_around(n);
    for (const std::uint32_t n : next) {
      if (place_[n] % 2 == 1) worker.serve(awake(n), stop);
    }
  }
}

// Lists the vertices whose turns a higher limit lets through. Turns know no limit: those beyond the last limit have
// been kept.
void LocalMinima::list_let_through() {
  woken_.clear();
  if (zone_.limit <= limit_) return;
  collect(
      executor_, static_cast<std::int64_t>(zone_.turn_keys.size()), 65536,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          const CostBits cost = cost_of(zone_.turn_keys[v]);
          if (cost > limit_ && cost <= zone_.limit) list.push_back(v);
        }
      },
      woken_);
}

void LocalMinima::wake_waiters_of_settled() {
  for (const Index v : zone_.settled.old) {
    if (is_unknown(zone_.turn_keys[v])) continue;
    Turn& turn = zone_.turns[v];
    for (Index w = turn.first_waiter; w != kNone; w = zone_.turns[w].next_waiter) {
      zone_.turns[w].waits_for = kNone;
      woken_.push_back(w);
    }
    turn.first_waiter = kNone;
  }
}

Index LocalMinima::awake(std::size_t n) const {
  const std::vector<Index>& old = zone_.settled.old;
  return n < old.size() ? old[n] : woken_[n - old.size()];
}

// Whether v, which has a turn, and the other end of its least edge are a pair.
bool LocalMinima::is_in_pair(Index v) const { return same_turn(zone_, v, other_end(zone_, zone_.turns[v].edge, v)); }

// Groups the vertices that have a turn by columns of the volume.
void LocalMinima::group_by_place() {
  const Columns column(zone_.options.a0);
  place_.resize(zone_.settled.old.size() + woken_.size());
  triangle_.resize(place_.size());
  executor_.for_each(static_cast<std::int64_t>(place_.size()), 4096, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    const Index v = awake(n);
    place_[n] = kNowhere;
    if (!has_turn(zone_, v)) return;
    place_[n] = 2 * column(zone_.vertices[v].position) + (is_in_pair(v) ? 1 : 0);
    triangle_[n] = zone_.vertices[v].half_edge >> 2;
  });
  fill_buckets(
      executor_, static_cast<std::uint32_t>(place_.size()), kPlaces, [&](std::uint32_t n) { return place_[n] / 2; },
      places_);
}

}  // namespace isoweave
