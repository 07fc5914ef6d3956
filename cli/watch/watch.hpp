// mesh --watch: a page on this machine that shows the sweep while it runs. It never changes the result and never waits
// for a browser; builds without the viewer or without cpp-httplib refuse it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "isoweave/pipeline.hpp"
#include "isoweave/volume.hpp"
#include "options/cli_app.hpp"

namespace isoweave::cli {

struct WatchOptions {
  std::string port;  // empty: nobody watches; "0": any port that is free

  bool given() const { return !port.empty(); }
};

// Adds --watch. Must be called after --quiet and --dry-run, with which it does not go.
void add_watch_option(CLI::App& verb, WatchOptions& watch);

// Refuses with std::invalid_argument, before any work: a build that has no page, and an invalid port.
void check_watch(const WatchOptions& watch);

// The most bytes that watching holds.
std::uint64_t watch_memory(const WatchOptions& watch);

// The facts of the run for the pages that watch it.
struct WatchedRun {
  const VolumeInfo& volume;
  const MeshOptions& options;
  std::string input, output;    // names
  std::int64_t resumed_at = 0;  // layers that an earlier process has done
};

class Watch : public SweepObserver {
 public:
  // Tells that the run is complete. Serving continues until the end of this object.
  virtual void complete(const MeshReport& report) = 0;

  // Returns when all watching pages have the result, when none has asked for five seconds, after half a minute, or once
  // `stop` is set.
  virtual void deliver(const std::atomic<bool>& stop) const = 0;
};

// Prints the address of the page on standard error. Returns null where nobody watches: it was not asked for, or the
// port cannot be had, which is a note and no error.
std::shared_ptr<Watch> start_watch(const WatchOptions& watch, const WatchedRun& run);

}  // namespace isoweave::cli
