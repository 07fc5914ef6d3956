#include "watch/watch_feed.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace isoweave::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "the page reads numbers as they are in memory");

void append_bytes(std::string& text, const void* bytes, std::size_t size) {
  text.append(static_cast<const char*>(bytes), size);
}

void append_triangles(std::string& text, std::span<const GridTriangle> triangles) {
  append_bytes(text, triangles.data(), triangles.size_bytes());
}

SlabRecord merged(const SlabRecord& before, const SlabRecord& after) {
  SlabRecord both = after;
  both.live_triangles = std::max(before.live_triangles, after.live_triangles);
  both.undecided_triangles = std::max(before.undecided_triangles, after.undecided_triangles);
  both.bytes = std::max(before.bytes, after.bytes);
  return both;
}

}  // namespace

void SweepPlot::add(const SlabRecord& slab) {
  if (in_last_ == slabs_per_step_) {
    if (steps_.size() + 1 == kMost) halve();
    in_last_ = 0;
  }
  if (in_last_++ == 0) {
    steps_.push_back(slab);
  } else {
    steps_.back() = merged(steps_.back(), slab);
  }
}

// Joins steps two by two. A last step without a neighbour is taken for a full one.
void SweepPlot::halve() {
  std::vector<SlabRecord> coarser;
  for (std::size_t n = 0; n < steps_.size(); n += 2) {
    coarser.push_back(n + 1 < steps_.size() ? merged(steps_[n], steps_[n + 1]) : steps_[n]);
  }
  steps_ = std::move(coarser);
  slabs_per_step_ *= 2;
}

Json SweepPlot::json() const {
  Json json = {{"layer", Json::array()},
               {"live", Json::array()},
               {"undecided", Json::array()},
               {"final", Json::array()},
               {"bytes", Json::array()}};
  for (const SlabRecord& step : steps_) {
    json["layer"].push_back(step.layer);
    json["live"].push_back(step.live_triangles);
    json["undecided"].push_back(step.undecided_triangles);
    json["final"].push_back(step.final_triangles);
    json["bytes"].push_back(step.bytes);
  }
  return json;
}

void WatchFeed::add_final(std::span<const TriangleCorners> triangles) {
  Frame placed(triangles.size());
  std::ranges::transform(triangles, placed.begin(), [&](const TriangleCorners& t) { return grid_.place(t); });
  const std::lock_guard lock(mutex_);
  for (const GridTriangle& triangle : placed) final_.add(triangle);
}

void WatchFeed::end_slab(const Progress& progress, const SlabRecord& slab) {
  const std::lock_guard lock(mutex_);
  progress_ = progress;
  slab_ = slab;
  plot_.add(slab);
  last_ = Clock::now();
  if (!first_) first_ = Mark{last_, progress.voxels};
}

void WatchFeed::show(const CoarseSurface& undecided) {
  auto frame = std::make_shared<const Frame>(undecided.triangles().begin(), undecided.triangles().end());
  const std::lock_guard lock(mutex_);
  final_.mark();
  undecided_ = std::move(frame);
  undecided_bits_ = undecided.bits();
  frame_layer_ = slab_.layer;
  ++frame_;
}

void WatchFeed::complete(Json result) {
  const std::lock_guard lock(mutex_);
  result_ = std::move(result);
}

void WatchFeed::visit() {
  const std::lock_guard lock(mutex_);
  asked_ = Clock::now();
}

bool WatchFeed::asked_within(Clock::duration period) const {
  const std::lock_guard lock(mutex_);
  return asked_ && Clock::now() - *asked_ <= period;
}

bool WatchFeed::is_delivered() const {
  const std::lock_guard lock(mutex_);
  return delivered_;
}

// The width of the cells whose vertices have become one.
double WatchFeed::cell(int bits) const { return bits == 0 ? 0 : std::ldexp(grid_.step, bits); }

// The speed of this process; an earlier one may have read some of the voxels.
double WatchFeed::voxels_per_second() const {
  if (!first_) return 0;
  const bool more = last_ > first_->time;
  const std::uint64_t voxels = progress_.voxels - (more ? first_->voxels : 0);
  const double seconds = std::chrono::duration<double>(last_ - (more ? first_->time : start_)).count();
  return seconds > 0 ? static_cast<double>(voxels) / seconds : 0;
}

Json WatchFeed::numbers() const {
  return {{"layer", progress_.layer},
          {"layers", progress_.layers},
          {"voxels", progress_.voxels},
          {"voxels_per_second", voxels_per_second()},
          {"seconds", std::chrono::duration<double>((result_ ? last_ : Clock::now()) - start_).count()},
          {"live", slab_.live_triangles},
          {"undecided", slab_.undecided_triangles},
          {"final", slab_.final_triangles},
          {"bytes", slab_.bytes}};
}

std::string WatchFeed::answer(const WatchQuery& query) {
  std::unique_lock lock(mutex_);
  asked_ = Clock::now();
  const std::span<const GridTriangle> held = final_.marked();
  const bool same = query.final_bits == final_.bits() && query.final_count <= held.size();
  const std::span<const GridTriangle> rest = held.subspan(same ? query.final_count : 0);
  const std::span<const GridTriangle> more = rest.first(std::min(rest.size(), kMostAtOnce));
  const std::shared_ptr<const Frame> undecided = query.frame == frame_ ? nullptr : undecided_;
  Json json = {{"numbers", numbers()}, {"plot", plot_.json()}, {"frame", frame_}, {"frame_layer", frame_layer_}};
  json["final"] = {{"bits", final_.bits()},
                   {"from", held.size() - rest.size()},
                   {"triangles", more.size()},
                   {"held", held.size()},
                   {"cell", cell(final_.bits())}};
  json["undecided"] = {{"triangles", undecided ? undecided->size() : 0}, {"cell", cell(undecided_bits_)}};
  if (result_) json["result"] = *result_;
  delivered_ = delivered_ || (result_ && more.size() == rest.size());

  std::string text = json.dump();
  if (text.size() % 2 == 1) text += ' ';
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string answer;
  answer.reserve(sizeof(length) + length + sizeof(GridTriangle) * (more.size() + (undecided ? undecided->size() : 0)));
  append_bytes(answer, &length, sizeof(length));
  answer += text;
  append_triangles(answer, more);
  lock.unlock();
  if (undecided) append_triangles(answer, *undecided);
  return answer;
}

}  // namespace isoweave::cli
