#include "simplify/driver.hpp"

#include "simplify/turns.hpp"

namespace isoweave {

void give_all_turns(const Zone& zone) {
  for (Index v = 0; v < zone.vertices.size(); ++v) give_turn(zone, v);
}

void give_turns(const Zone& zone, const Executor& executor) {
  executor.for_each(static_cast<std::int64_t>(zone.settled.size()), 4096,
                    [&](std::int64_t n) { give_turn(zone, zone.settled[static_cast<std::size_t>(n)]); });
}

}  // namespace isoweave
