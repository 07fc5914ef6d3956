// --watch in builds that have it.
#include "watch.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "mesh_output.hpp"
#include "options.hpp"
#include "output.hpp"
#include "output/world.hpp"
#include "page_script.hpp"
#include "page_template.hpp"
#include "report.hpp"
#include "watch_feed.hpp"
#include "watch_server.hpp"
#include "watch_surface.hpp"

namespace isoweave::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// The place of index (i, j, k).
Point place_of(const VolumeInfo& volume, const World& world, const std::array<double, 3>& index) {
  const auto& spacing = volume.geometry.spacing;
  return world.point({index[0] * spacing[0], index[1] * spacing[1], index[2] * spacing[2]});
}

// The grid around the samples and the caps, which are within a sample of them.
ViewGrid grid_of(const VolumeInfo& volume, const World& world) {
  std::vector<Point> corners;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::array<double, 3> index{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      index[axis] = (corner >> axis & 1U) == 0 ? -1.0 : static_cast<double>(volume.dims[axis]);
    }
    corners.push_back(place_of(volume, world, index));
  }
  return ViewGrid::around(corners);
}

// The corners of the first slice and of the next, from which the page knows the places of all slices.
Json slices_json(const VolumeInfo& volume, const World& world) {
  const double i = static_cast<double>(volume.dims[0] - 1);
  const double j = static_cast<double>(volume.dims[1] - 1);
  return {{"corners",
           {place_of(volume, world, {0, 0, 0}), place_of(volume, world, {i, 0, 0}), place_of(volume, world, {i, j, 0}),
            place_of(volume, world, {0, j, 0})}},
          {"next", place_of(volume, world, {0, 0, 1})},
          {"count", volume.dims[2]}};
}

Json run_json(const WatchedRun& run, const World& world, const ViewGrid& grid) {
  return {{"version", ISOWEAVE_VERSION},
          {"input", run.input},
          {"output", run.output},
          {"dims", run.volume.dims},
          {"iso", run.options.iso},
          {"closed", run.options.closed},
          {"unit", run.volume.geometry.unit},
          {"space", space_text(run.volume.geometry, run.options.space)},
          {"resumed_at", run.resumed_at},
          {"grid", {{"origin", grid.origin}, {"step", grid.step}}},
          {"slices", slices_json(run.volume, world)},
          {"most_final", kMostFinalDrawn},
          {"most_undecided", kMostUndecidedDrawn}};
}

std::string page_text(const Json& run) {
  const std::string_view html = watch_template();
  const std::size_t mark = html.find(kPageMark);
  return fmt::format("{}{}{}{}{}", html.substr(0, mark), script_start("run"), script_text(run), kScriptEnd,
                     html.substr(mark + kPageMark.size()));
}

class SweepWatch final : public Watch {
 public:
  SweepWatch(const WatchedRun& run, const World& world, int port)
      : feed_(grid_of(run.volume, world)),
        server_(
            port, page_text(run_json(run, world, feed_.grid())), [this] { feed_.visit(); },
            [this](const WatchQuery& query) { return feed_.answer(query); }) {}

  std::string url() const { return server_.url(); }

  void add_final(std::span<const TriangleCorners> triangles) override { feed_.add_final(triangles); }

  void end_slab(const Progress& progress, const SlabRecord& slab,
                const std::function<void(const Visitor&)>& visit_undecided) override {
    feed_.end_slab(progress, slab);
    const bool nothing = slab.undecided_triangles == 0;
    if (!nothing && (Clock::now() < next_frame_ || !feed_.asked_within(kPresence))) return;
    const Clock::time_point start = Clock::now();
    show(slab, visit_undecided);
    const Clock::time_point end = Clock::now();
    next_frame_ = end + std::max<Clock::duration>(kFrame, kPauses * (end - start));
  }

  void complete(const MeshReport& report) override {
    feed_.complete({{"triangles", report.triangles},
                    {"vertices", report.vertices},
                    {"digest", digest_text(report.digest)},
                    {"seconds", report.seconds_total}});
  }

  void deliver(const std::atomic<bool>& stop) const override {
    const Clock::time_point end = Clock::now() + kGrace;
    if (!feed_.asked_within(kPresence)) return;
    // A page that has everything asks no more.
    const auto all_have_it = [&] { return feed_.is_delivered() && !feed_.asked_within(kQuiet) && server_.is_idle(); };
    while (!stop && Clock::now() < end && !all_have_it()) {
      std::this_thread::sleep_for(10ms);
    }
  }

 private:
  static constexpr Clock::duration kFrame = 100ms;  // no more frames than can be seen
  static constexpr int kPauses = 9;                 // so many times as long as a frame took: a tenth of the run
  static constexpr Clock::duration kPresence = 5s;  // browsers let pages in the background ask once a second
  static constexpr Clock::duration kQuiet = 400ms;
  static constexpr Clock::duration kGrace = 5s;

  // Shows the surface as coarse as last time, or one step finer: cells twice as wide leave a quarter of the triangles.
  void show(const SlabRecord& slab, const std::function<void(const Visitor&)>& visit_undecided) {
    CoarseSurface surface(kMostUndecidedDrawn, slab.undecided_triangles < kMostUndecidedDrawn ? 0 : bits_);
    visit_undecided([&](std::span<const TriangleCorners> block) {
      for (const TriangleCorners& triangle : block) surface.add(feed_.grid().place(triangle));
    });
    const bool sparse = 5 * surface.triangles().size() < kMostUndecidedDrawn;
    bits_ = std::max(surface.bits() - (sparse ? 1 : 0), 0);
    feed_.show(surface);
  }

  WatchFeed feed_;
  Clock::time_point next_frame_;
  int bits_ = 0;
  WatchServer server_;  // ends before what it reads
};

}  // namespace

std::shared_ptr<Watch> start_watch(const WatchOptions& watch, const WatchedRun& run) {
  if (!watch.given()) return nullptr;
  const int port = parse_port("--watch", watch.port);
  const World world(run.volume.geometry, run.options.space, mesh_offset(run.volume, run.options.space));
  try {
    auto started = std::make_unique<SweepWatch>(run, world, port);
    print_note("watch at " + started->url());
    return started;
  } catch (const std::runtime_error& error) {
    print_note(fmt::format("--watch={}: {}; the run goes on without a page", watch.port, error.what()));
    return nullptr;
  }
}

}  // namespace isoweave::cli
