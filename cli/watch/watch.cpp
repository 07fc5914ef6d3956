// --watch in builds that have it.
#include "watch/watch.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "isoweave/mesh_options.hpp"
#include "options/output_mesh.hpp"
#include "options/values.hpp"
#include "page/page_script.hpp"
#include "page/page_template.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "watch/watch_feed.hpp"
#include "watch/watch_server.hpp"
#include "watch/watch_surface.hpp"

namespace isoweave::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// The places of samples as the sweep gives them: relative to the offset of the mesh.
class SamplePlaces {
 public:
  explicit SamplePlaces(const WatchedRun& run)
      : volume_(run.volume), space_(run.options.space), offset_(mesh_offset(run.volume, run.options.space)) {}

  const VolumeInfo& volume() const { return volume_; }

  // The place of index (i, j, k).
  Point at(const std::array<double, 3>& index) const {
    const std::array<double, 3> place = output_place(volume_, space_, index);
    Point point{};
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(place[axis] - offset_[axis]);
    return point;
  }

 private:
  const VolumeInfo& volume_;
  OutputSpace space_;
  std::array<double, 3> offset_;
};

// The grid around the samples and the caps, which are within a sample of them.
ViewGrid grid_of(const SamplePlaces& places) {
  std::vector<Point> corners;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::array<double, 3> index{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      index[axis] = (corner >> axis & 1U) == 0 ? -1.0 : static_cast<double>(places.volume().dims[axis]);
    }
    corners.push_back(places.at(index));
  }
  return ViewGrid::around(corners);
}

// The corners of the first slice and of the next, from which the page knows the places of all slices.
Json slices_json(const SamplePlaces& places) {
  const std::array<std::int64_t, 3>& dims = places.volume().dims;
  const auto i = static_cast<double>(dims[0] - 1);
  const auto j = static_cast<double>(dims[1] - 1);
  return {{"corners", {places.at({0, 0, 0}), places.at({i, 0, 0}), places.at({i, j, 0}), places.at({0, j, 0})}},
          {"next", places.at({0, 0, 1})},
          {"count", dims[2]}};
}

Json run_json(const WatchedRun& run, const SamplePlaces& places, const ViewGrid& grid) {
  return {{"version", ISOWEAVE_VERSION},
          {"input", run.input},
          {"output", run.output},
          {"dims", run.volume.dims},
          {"iso", run.options.iso},
          {"closed", run.options.closed},
          {"unit", run.volume.geometry.unit},
          {"space", space_of_mesh(run.volume.geometry, run.options.space)},
          {"resumed_at", run.resumed_at},
          {"grid", {{"origin", grid.origin}, {"step", grid.step}}},
          {"slices", slices_json(places)},
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
  SweepWatch(const WatchedRun& run, const SamplePlaces& places, int port)
      : feed_(grid_of(places)),
        server_(
            port, page_text(run_json(run, places, feed_.grid())), [this] { feed_.visit(); },
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
    // A page that has everything asks no more, nor does one that was closed. One that draws slowly goes on asking.
    const auto all_have_it = [&] { return feed_.is_delivered() && !feed_.asked_within(kQuiet) && server_.is_idle(); };
    while (!stop && Clock::now() < end && feed_.asked_within(kPresence) && !all_have_it()) {
      std::this_thread::sleep_for(10ms);
    }
  }

 private:
  static constexpr Clock::duration kFrame = 100ms;  // no more frames than can be seen
  static constexpr int kPauses = 9;                 // so many times as long as a frame took: a tenth of the run
  static constexpr Clock::duration kPresence = 5s;  // browsers let pages in the background ask once a second
  static constexpr Clock::duration kQuiet = 400ms;
  static constexpr Clock::duration kGrace = 30s;

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
  try {
    auto started = std::make_unique<SweepWatch>(run, SamplePlaces(run), port);
    print_note("watch at " + started->url());
    return started;
  } catch (const std::runtime_error& error) {
    print_note(fmt::format("--watch={}: {}; the run goes on without a page", watch.port, error.what()));
    return nullptr;
  }
}

}  // namespace isoweave::cli
