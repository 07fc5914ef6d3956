#include "pairs.hpp"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>

namespace bench {
namespace {

// Counts nearer than this to the one asked for are as good as equal.
constexpr double kCountTolerance = 0.005;
constexpr int kMostTries = 24;
constexpr double kCloseTimes = 5;    // a peer that takes fewer times our time is close, and noise matters
constexpr int kLeastOfClose = 5;     // rounds of such a pair
constexpr double kMoreOfClose = 10;  // times as long as it takes others to have had enough
constexpr std::int64_t kMemoryOfFirstRun = std::int64_t{2} << 30;  // no peak of the pair is known yet
constexpr double kFinestStep = 1e-3;  // of the logarithm of a length: what changes the count by a jump is found by then

// From here on, the peak is that of what follows.
void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

std::int64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::int64_t resident_bytes() {
  std::int64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

// "bytes_before" holds the input in the contestant's own structures: what the run adds is the peak above it.
Json measure(const Runner& runner, const Goal& goal, const FullSurface* full) {
  const std::unique_ptr<Task> task = runner.start(goal);
  malloc_trim(0);  // freed memory of the conversion would hide what the run adds
  reset_peak_memory();
  const std::int64_t before = resident_bytes();
  const auto start = std::chrono::steady_clock::now();
  task->run();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  Json json{{"seconds", seconds.count()},
            {"threads", goal.threads},
            {"triangles", task->triangles()},
            {"peak_bytes", peak_bytes()},
            {"bytes_before", before}};
  if (full != nullptr) json["quality"] = quality(task->mesh(), *full);
  return json;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

// All runs of one contestant with one number of threads.
struct Series {
  std::vector<Json> runs;
  std::string failure;

  std::vector<double> seconds() const {
    std::vector<double> all;
    for (const Json& run : runs) all.push_back(run["seconds"]);
    return all;
  }

  std::int64_t peak_bytes() const {
    std::int64_t peak = 0;
    for (const Json& run : runs) peak = std::max(peak, run["peak_bytes"].get<std::int64_t>());
    return peak;
  }

  // The first run with the median time and the largest peak.
  Json summary(const Json& quality) const {
    if (!failure.empty()) return {{"failure", failure}};
    Json json = runs.front();
    if (!quality.is_null()) json["quality"] = quality;
    json["seconds"] = median(seconds());
    json["peak_bytes"] = peak_bytes();
    return json;
  }
};

// The larger peak of two contestants.
std::int64_t memory_of_pair(const std::map<int, Series>& ours, const std::map<int, Series>& peer) {
  std::int64_t peak = 0;
  for (const auto* all : {&ours, &peer}) {
    for (const auto& [threads, series] : *all) peak = std::max(peak, series.peak_bytes());
  }
  return peak == 0 ? kMemoryOfFirstRun : peak;
}

// Runs once more unless it failed before.
void repeat(Entry& entry, int threads, const Settings& settings, const FullSurface* full, std::int64_t memory,
            Series& series) {
  if (!series.failure.empty()) return;
  Goal goal = entry.goal;
  goal.threads = threads;
  const FullSurface* const reference = entry.quality.is_null() ? full : nullptr;
  have_host_provide_memory(memory);
  Outcome outcome = run_in_child([&] { return measure(entry.runner, goal, reference); }, settings.limit_seconds);
  series.failure = std::move(outcome.failure);
  if (!series.failure.empty()) return;
  if (outcome.result.contains("quality")) entry.quality = outcome.result["quality"];
  series.runs.push_back(std::move(outcome.result));
}

double total_seconds(const std::map<int, Series>& all) {
  double total = 0;
  for (const auto& [threads, series] : all) {
    for (const double seconds : series.seconds()) total += seconds;
  }
  return total;
}

bool any_failed(const std::map<int, Series>& all) {
  return std::any_of(all.begin(), all.end(), [](const auto& series) { return !series.second.failure.empty(); });
}

Json row(const Entry& ours, const Entry& peer, int threads, const Series& our_series, const Series& peer_series) {
  Json json{
      {"ours", our_series.summary(ours.quality)}, {"peer", peer_series.summary(peer.quality)}, {"threads", threads}};
  json["ours"]["name"] = ours.runner.name;
  json["ours"]["length"] = ours.goal.length;
  json["peer"]["name"] = peer.runner.name;
  const std::vector<double> our_seconds = our_series.seconds(), peer_seconds = peer_series.seconds();
  std::vector<double> ratios;
  for (std::size_t r = 0; r < std::min(our_seconds.size(), peer_seconds.size()); ++r) {
    ratios.push_back(peer_seconds[r] / our_seconds[r]);
  }
  if (ratios.empty()) return json;
  json["ratio"] = median(ratios);
  json["ratios"] = ratios;
  return json;
}

// The logarithm of a length between two others at which the logarithm of the count should be the one asked for; kept
// off the ends, so that every try makes the bracket smaller.
double interpolate(double low, double high, double low_count, double high_count, double count) {
  const double share = low_count > high_count ? (low_count - count) / (low_count - high_count) : 0.5;
  return low + (high - low) * std::clamp(share, 0.1, 0.9);
}

}  // namespace

std::string steer(const Runner& runner, double voxel, double limit_seconds, Goal& goal) {
  double low = std::log(runner.steering->low * voxel), high = std::log(runner.steering->high * voxel);
  const double wanted = static_cast<double>(goal.triangles);
  double low_count = 0, high_count = 0;  // logarithms; 0: not known, and the bracket is halved
  Goal nearest = goal;
  double nearest_miss = INFINITY;
  for (int tries = 0; tries < kMostTries && nearest_miss > kCountTolerance && high - low > kFinestStep; ++tries) {
    const bool both_known = low_count > 0 && high_count > 0;
    const double length =
        both_known ? interpolate(low, high, low_count, high_count, std::log(wanted)) : (low + high) / 2;
    Goal attempt = goal;
    attempt.length = std::exp(length);
    const Outcome outcome = run_in_child([&] { return measure(runner, attempt, nullptr); }, limit_seconds);
    if (!outcome.failure.empty()) return outcome.failure;
    attempt.triangles = outcome.result["triangles"];
    const double count = static_cast<double>(attempt.triangles);
    const double miss = std::abs(count / wanted - 1);
    if (miss < nearest_miss) {
      nearest_miss = miss;
      nearest = attempt;
    }
    (count > wanted ? low : high) = length;
    (count > wanted ? low_count : high_count) = std::log(std::max(count, 2.0));
  }
  goal.length = nearest.length;
  goal.triangles = nearest.triangles;
  return {};
}

std::vector<Json> compare(Entry& ours, Entry& peer, const Settings& settings, const FullSurface* full) {
  std::map<int, Series> our_series, peer_series;
  const auto wants_more = [&](int rounds) {
    if (any_failed(peer_series)) return false;
    const double ours_took = total_seconds(our_series), peer_took = total_seconds(peer_series);
    const bool is_close = peer_took < kCloseTimes * ours_took && rounds < kLeastOfClose;
    return ours_took + peer_took < (is_close ? kMoreOfClose : 1) * settings.enough_seconds;
  };
  for (int round = 0; round < settings.most_rounds && wants_more(round); ++round) {
    for (const int threads : settings.threads) {
      const std::int64_t memory = memory_of_pair(our_series, peer_series);
      repeat(ours, threads, settings, full, memory, our_series[threads]);
      if (!peer.runner.parallel && threads != settings.threads.front()) continue;
      const int peer_threads = peer.runner.parallel ? threads : 1;
      repeat(peer, peer_threads, settings, full, memory, peer_series[peer_threads]);
    }
  }
  std::vector<Json> rows;
  for (const int threads : settings.threads) {
    rows.push_back(row(ours, peer, threads, our_series[threads], peer_series[peer.runner.parallel ? threads : 1]));
  }
  return rows;
}

}  // namespace bench
