// The options of --watch, and the checks on them before any work is done.
#include <CLI/CLI.hpp>
#include <stdexcept>

#include "options/values.hpp"
#include "watch/watch.hpp"

namespace isoweave::cli {
namespace {

void require_watch() {
#ifndef ISOWEAVE_HAS_WATCH
  throw std::invalid_argument(
      "--watch: expected a build with the viewer and cpp-httplib (CMake options ISOWEAVE_VIEWER=ON and "
      "ISOWEAVE_WATCH=ON), this one has no page to watch");
#endif
}

}  // namespace

void add_watch_option(CLI::App& verb, WatchOptions& watch) {
  // --watch is a flag, as a value that stands apart would be taken for the volume.
  verb.add_flag("--watch{0}", watch.port,
                "Show the sweep while it runs, in a browser on this machine; --watch=PORT: at this port")
      ->excludes("--quiet")
      ->excludes("--dry-run");
}

void check_watch(const WatchOptions& watch) {
  if (!watch.given()) return;
  require_watch();
  parse_port("--watch", watch.port);
}

std::uint64_t watch_memory(const WatchOptions& watch) { return watch.given() ? 64'000'000 : 0; }

}  // namespace isoweave::cli
