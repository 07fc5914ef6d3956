#include "simplify/rounds.hpp"

#include <mutex>

#include "parallel/collect.hpp"
#include "simplify/turns.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 1024;

}  // namespace

Rounds::Rounds(Zone& zone, Quality quality, const Executor& executor)
    : zone_(zone), quality_(quality), executor_(executor) {}

void Rounds::run(const std::atomic<bool>* stop) {
  give_turns(zone_, executor_);
  marks_.assign(zone_.vertices.size(), 0);
  changed_.resize(zone_.settled.size());
  for (std::size_t n = 0; n < changed_.size(); ++n) changed_[n] = zone_.settled[n];
  while (!changed_.empty() && !(stop != nullptr && stop->load(std::memory_order_relaxed))) {
    list_candidates();
    pick_minima();
    decide_minima();
    renew_turns();
    ++rounds_;
  }
}

// The vertices whose least edge may have become a local minimum: those changed and their neighbours.
void Rounds::list_candidates() {
  const auto add = [&](Index v, std::vector<Index>& list) {
    if (!has_turn(zone_, v)) return;
    if (std::atomic_ref(marks_[v]).exchange(1, std::memory_order_relaxed) == 0) list.push_back(v);
  };
  collect(
      executor_, static_cast<std::int64_t>(changed_.size()), kBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        Star star;
        for (std::int64_t n = begin; n < end; ++n) {
          const Index v = changed_[static_cast<std::size_t>(n)];
          add(v, list);
          if (is_unknown(zone_.turn_keys[v]) || !zone_.walkable(v)) continue;
          star.gather(zone_, v);
          star.each_neighbour(zone_, [&](Index w) {
            add(w, list);
            return true;
          });
        }
      },
      candidates_);
}

// The least edges of the candidates that are local minima. An edge with two candidates for ends is looked at from the
// smaller one.
void Rounds::pick_minima() {
  collect(
      executor_, static_cast<std::int64_t>(candidates_.size()), kBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        Star star;
        for (std::int64_t n = begin; n < end; ++n) {
          const Index v = candidates_[static_cast<std::size_t>(n)];
          const Index edge = zone_.turns[v].edge;
          const Index other = other_end(zone_, edge, v);
          if (!same_turn(zone_, v, other)) continue;
          if (marks_[other] != 0 && other < v) continue;
          bool least = true;
          for (const Index end_vertex : {v, other}) {
            star.gather(zone_, end_vertex);
            least = least && star.each_neighbour(zone_, [&](Index w) { return !earlier(zone_, w, v); });
          }
          if (least) list.push_back(edge);
        }
      },
      minima_);
  executor_.for_each(static_cast<std::int64_t>(candidates_.size()), kBlock,
                     [&](std::int64_t n) { marks_[candidates_[static_cast<std::size_t>(n)]] = 0; });
}

// Decides the minima and lists the vertices at whose edges something has changed.
void Rounds::decide_minima() {
  std::mutex counting;
  collect(
      executor_, static_cast<std::int64_t>(minima_.size()), kBlock / 16,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        Decider decider(zone_, quality_);
        const auto add = [&](Index v) {
          if (std::atomic_ref(marks_[v]).exchange(1, std::memory_order_relaxed) == 0) list.push_back(v);
        };
        for (std::int64_t n = begin; n < end; ++n) {
          decider.look_at(minima_[static_cast<std::size_t>(n)]);
          decider.decide();
          add(decider.first().vertex);
          add(decider.second().vertex);
          if (!decider.collapsed()) continue;
          decider.merged().each_neighbour(zone_, [&](Index w) {
            if (has_turn(zone_, w)) add(w);
            return true;
          });
        }
        const std::lock_guard guard(counting);
        counts_ += decider.counts();
      },
      changed_);
}

void Rounds::renew_turns() {
  executor_.for_each(static_cast<std::int64_t>(changed_.size()), kBlock, [&](std::int64_t n) {
    const Index v = changed_[static_cast<std::size_t>(n)];
    marks_[v] = 0;
    if (!exists(zone_.vertices[v].half_edge)) {
      zone_.turn_keys[v] = kNoTurn;
    } else if (has_turn(zone_, v)) {
      renew_turn(zone_, v);
    }
  });
}

}  // namespace isoweave
