// The messages to a page that watches a sweep. The sweep's thread puts data in and the server's threads take them out.
// Neither waits for the other longer than it takes to copy a megabyte.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "report/report.hpp"
#include "watch/watch_surface.hpp"

namespace isoweave::cli {

inline constexpr std::size_t kMostFinalDrawn = 375'000;
inline constexpr std::size_t kMostUndecidedDrawn = 187'500;

// The data that a page has already.
struct WatchQuery {
  int final_bits = 0;             // of the final triangles
  std::uint64_t final_count = 0;  // of them
  std::uint64_t frame = 0;        // number of the one that it shows; 0: none
};

// The sweep in fewer than kMost steps, however many slabs there are. Of slabs that share a step the largest counts.
class SweepPlot {
 public:
  void add(const SlabRecord& slab);
  Json json() const;

 private:
  static constexpr std::size_t kMost = 512;

  void halve();

  std::vector<SlabRecord> steps_;
  std::uint64_t slabs_per_step_ = 1;
  std::uint64_t in_last_ = 1;  // slabs; a full step: the next slab begins one
};

class WatchFeed {
 public:
  using Clock = std::chrono::steady_clock;

  explicit WatchFeed(const ViewGrid& grid) : grid_(grid) {}

  void add_final(std::span<const TriangleCorners> triangles);
  void end_slab(const Progress& progress, const SlabRecord& slab);

  // Sets the undecided surface after that slab. Triangles that have become final up to there are shown only now, so
  // that the two fit together.
  void show(const CoarseSurface& undecided);
  void complete(Json result);

  const ViewGrid& grid() const { return grid_; }

  // Tells that a page has been sent, and will ask.
  void visit();

  // Whether a page has asked in the last `period`.
  bool asked_within(Clock::duration period) const;

  // Whether some page has everything, the result too.
  bool is_delivered() const;

  // Any thread: the data that have come since, as
  //   4 bytes    length of the JSON that follows, little-endian; even
  //   JSON       numbers, and how many triangles follow
  //   18 bytes   each of the final triangles, no more than kMostAtOnce, and of the undecided ones if they are others:
  //              GridTriangle, little-endian
  std::string answer(const WatchQuery& query);

 private:
  static constexpr std::size_t kMostAtOnce = 65'536;

  using Frame = std::vector<GridTriangle>;

  double cell(int bits) const;
  double voxels_per_second() const;
  Json numbers() const;

  const ViewGrid grid_;
  const Clock::time_point start_ = Clock::now();

  mutable std::mutex mutex_;  // what follows
  CoarseSurface final_{kMostFinalDrawn};
  std::shared_ptr<const Frame> undecided_ = std::make_shared<const Frame>();
  int undecided_bits_ = 0;
  std::uint64_t frame_ = 0;  // how many there have been
  std::int64_t frame_layer_ = 0;
  Progress progress_;
  SlabRecord slab_;
  SweepPlot plot_;
  struct Mark {
    Clock::time_point time;
    std::uint64_t voxels;
  };
  std::optional<Mark> first_;  // slab that this process has done
  Clock::time_point last_ = start_;
  std::optional<Json> result_;
  std::optional<Clock::time_point> asked_;
  bool delivered_ = false;
};

}  // namespace isoweave::cli
