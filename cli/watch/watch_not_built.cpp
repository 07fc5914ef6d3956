// Stands in for the page that shows a sweep in builds without it. check_watch has refused before.
#include <stdexcept>

#include "watch/watch.hpp"

namespace isoweave::cli {

std::shared_ptr<Watch> start_watch(const WatchOptions& watch, const WatchedRun&) {
  if (!watch.given()) return nullptr;
  throw std::logic_error("a page to watch in a build without it");
}

}  // namespace isoweave::cli
