// Ranks by counted work: every block of a volume is worked on once, here, and schedules of any number of ranks are made
// of the counts.
//
//   bench_ranks VOLUME ISO ERROR BLOCK [--open]
//
// VOLUME is a file, ERROR is in voxels, BLOCK in cells along each side of a block. Prints two tables for
// docs/distributed.md: the volume by 1 to 64 ranks, and a volume that grows with the ranks, of copies of this one. Work
// is counted in triangles that are extracted. One that is taken over from the stage before counts as 0.4 of it, which
// is the median of the times in docs/distributed.md, and 128 cells that are read as one. The efficiency is the work of
// one sweep over that of all ranks until the last one ends, waiting included.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <queue>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/generate.hpp"
#include "isoweave/volume.hpp"
#include "pipeline/parts/task_work.hpp"
#include "pipeline/ranks/rank_plan.hpp"

namespace isoweave {
namespace {

constexpr double kTakenOver = 0.4;
constexpr double kCellsPerTriangle = 128;
constexpr int kBlocksOfRank = 4;  // where the volume grows

// The counts of a task.
struct TaskCost {
  double work = 0;
  std::map<std::uint64_t, std::uint64_t> bytes;  // that it leaves each task
};

struct Costs {
  std::vector<TaskCost> tasks;
  std::vector<std::uint64_t> weights;  // of the first stage
  double sweep = 0;                    // the work of one sweep
  double triangles = 0;                // extracted
};

double cells_of(const BlockStages& stages, std::uint64_t task) {
  const CellBox box = stages.grids[0].cells(stages.block(0, task), stages.all);
  double cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) cells *= static_cast<double>(box.end[axis] - box.first[axis]);
  return cells;
}

class Measurement {
 public:
  Measurement(const VolumeOpener& open, const Task& task, const BlockStages& stages)
      : open_(open), task_(task), stages_(stages) {}

  Costs run() {
    const TaskList list = stages_.tasks();
    for (std::uint64_t n = 0; n < list.count(); ++n) {
      const bool first = list.stage_of(n) == 0;
      TaskWork work(task_, task_.simplify.zone.retire, stages_, n, control_, executor_, [] {});
      TaskResult result = first ? work.extract(open_) : work.glue(std::exchange(parts_[n], {}));
      add(n, first, result);
    }
    return std::move(costs_);
  }

 private:
  void add(std::uint64_t n, bool first, TaskResult& result) {
    TaskCost& cost = costs_.tasks.emplace_back();
    cost.work = static_cast<double>(result.facts.counts.taken) * (first ? 1 : kTakenOver);
    if (first) {
      costs_.triangles += cost.work;
      cost.work += cells_of(stages_, n) / kCellsPerTriangle;
      costs_.sweep += cost.work;
      const CellBox cells = stages_.grids[0].cells(stages_.block(0, n), stages_.all);
      costs_.weights.push_back(block_weight(open_, cells, task_));
    }
    for (SplitPart& part : result.parts) {
      StateWriter writer;
      write_part(writer, part.part);
      cost.bytes[part.owner] = writer.take().size();
      parts_[part.owner].push_back(std::move(part.part));
    }
  }

  const VolumeOpener& open_;
  const Task& task_;
  const BlockStages& stages_;
  const RunControl control_{};
  const Executor executor_{0};
  std::map<std::uint64_t, std::vector<ZonePart>> parts_;
  Costs costs_;
};

// The schedule of some ranks: when the last one ends, and what they send.
struct Outcome {
  double end = 0;
  double bytes = 0;
  double imbalance = 0;  // the most work of a rank over the mean
};

class Schedule {
 public:
  // work(task) and bytes(task, taker): the counts of a task.
  template <class Work, class Bytes>
  Outcome run(const BlockStages& stages, const std::vector<std::uint32_t>& owners, int ranks, const Work& work,
              const Bytes& bytes) {
    const std::uint64_t count = stages.tasks().count();
    std::vector<std::size_t> missing(count);
    std::vector<std::set<std::uint64_t>> ready(static_cast<std::size_t>(ranks));
    std::vector<bool> busy(static_cast<std::size_t>(ranks), false);
    std::vector<double> sums(static_cast<std::size_t>(ranks), 0.0);
    using End = std::pair<double, std::uint64_t>;
    std::priority_queue<End, std::vector<End>, std::greater<>> running;
    Outcome outcome;
    const auto begin = [&](std::uint32_t rank, double now) {
      if (busy[rank] || ready[rank].empty()) return;
      const std::uint64_t task = ready[rank].extract(ready[rank].begin()).value();
      busy[rank] = true;
      sums[rank] += work(task);
      running.emplace(now + work(task), task);
    };
    for (std::uint64_t task = 0; task < count; ++task) {
      missing[task] = stages.givers_of(task).size();
      if (missing[task] == 0) ready[owners[task]].insert(task);
    }
    for (std::uint32_t rank = 0; rank < static_cast<std::uint32_t>(ranks); ++rank) begin(rank, 0);
    while (!running.empty()) {
      const auto [now, task] = running.top();
      running.pop();
      outcome.end = now;
      busy[owners[task]] = false;
      for (const std::uint64_t taker : stages.takers_of(task)) {
        if (owners[taker] != owners[task]) outcome.bytes += bytes(task, taker);
        if (--missing[taker] == 0) ready[owners[taker]].insert(taker);
        begin(owners[taker], now);
      }
      begin(owners[task], now);
    }
    double all = 0;
    for (const double sum : sums) all += sum;
    outcome.imbalance = *std::max_element(sums.begin(), sums.end()) * ranks / all;
    return outcome;
  }
};

void print_row(int ranks, const Outcome& outcome, double sweep, double triangles) {
  std::printf("| %d | %.0f | %.2f | %.1f |\n", ranks, 100 * sweep / (outcome.end * ranks), outcome.imbalance,
              outcome.bytes / triangles);
}

// One volume by more and more ranks.
void print_strong(const BlockStages& stages, const Costs& costs) {
  for (const int ranks : {1, 2, 4, 8, 16, 32, 64}) {
    const Outcome outcome = Schedule().run(
        stages, plan_ranks(stages, costs.weights, ranks), ranks,
        [&](std::uint64_t task) { return costs.tasks[task].work; },
        [&](std::uint64_t task, std::uint64_t taker) {
          const auto found = costs.tasks[task].bytes.find(taker);
          return found == costs.tasks[task].bytes.end() ? 0.0 : static_cast<double>(found->second);
        });
    print_row(ranks, outcome, costs.sweep, costs.triangles);
  }
}

// A volume of copies of the one that was measured. Blocks of the first four stages have the counts of those at their
// place in the copy. Later ones, which are larger, have their share of what all copies take in: as was measured for
// that stage, and beyond falling as it fell last.
class Copies {
 public:
  Copies(const BlockStages& one, const Costs& costs, const BlockStages& all, double copies)
      : one_(one), costs_(costs), all_(all), one_list_(one.tasks()), list_(all.tasks()) {
    std::vector<double> sums;
    for (std::size_t stage = 0; stage < list_.stages.size(); ++stage) {
      sums.push_back(stage < one_list_.stages.size() ? measured(stage) : beyond(sums));
      mean_.push_back(sums.back() * copies / static_cast<double>(list_.stages[stage]));
    }
  }

  double work(std::uint64_t task) const {
    const std::size_t stage = list_.stage_of(task);
    return stage >= 4 ? mean_[stage] : costs_.tasks[original(stage, task)].work;
  }

  double bytes(std::uint64_t task) const {
    const std::size_t stage = list_.stage_of(task);
    if (stage >= 4) return 0;
    const TaskCost& cost = costs_.tasks[original(stage, task)];
    double sum = 0;
    for (const auto& [taker, bytes] : cost.bytes) sum += static_cast<double>(bytes);
    return sum / static_cast<double>(std::max<std::size_t>(cost.bytes.size(), 1));
  }

  std::vector<std::uint64_t> weights() const {
    std::vector<std::uint64_t> weights;
    for (std::uint64_t task = 0; task < list_.stages.front(); ++task)
      weights.push_back(costs_.weights[original(0, task)]);
    return weights;
  }

 private:
  double measured(std::size_t stage) const {
    double sum = 0;
    for (std::uint64_t n = 0; n < one_list_.stages[stage]; ++n) sum += costs_.tasks[one_list_.first_of(stage) + n].work;
    return sum;
  }

  static double beyond(const std::vector<double>& sums) {
    const double last = sums.back(), before = sums[sums.size() - 2];
    return before > 0 ? last * std::min(1.0, last / before) : 0;
  }

  std::uint64_t original(std::size_t stage, std::uint64_t task) const {
    const BlockIndex first = all_.first_block(stage), counts = one_.counts(stage);
    BlockIndex block = all_.block(stage, task - list_.first_of(stage));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block[axis] = one_.first_block(stage)[axis] + (block[axis] - first[axis]) % counts[axis];
    }
    return one_list_.first_of(stage) + one_.number(stage, block);
  }

  const BlockStages& one_;
  const Costs& costs_;
  const BlockStages& all_;
  const TaskList one_list_, list_;
  std::vector<double> mean_;  // work of a task, per stage
};

// As many copies as give each rank some blocks.
void print_weak(const VolumeInfo& info, const MeshOptions& options, const BlockOptions& blocks, const BlockStages& one,
                const Costs& costs) {
  for (const int ranks : {8, 64, 512, 4096}) {
    std::int64_t side = 1;
    while (static_cast<double>(one.tasks().stages.front() * static_cast<std::uint64_t>(side * side * side)) <
           static_cast<double>(ranks * kBlocksOfRank)) {
      ++side;
    }
    GenerateOptions larger;
    larger.kind = "box";
    for (std::size_t axis = 0; axis < 3; ++axis) larger.dims[axis] = info.dims[axis] * side;
    const BlockStages stages(resolve_blocks(RunKind::kBlocks, *generate_volume(larger), options, blocks, {}, {0, 0, 0}),
                             blocks);
    const auto copies = static_cast<double>(side * side * side);
    const Copies all(one, costs, stages, copies);
    const Outcome outcome = Schedule().run(
        stages, plan_ranks(stages, all.weights(), ranks), ranks, [&](std::uint64_t task) { return all.work(task); },
        [&](std::uint64_t task, std::uint64_t) { return all.bytes(task); });
    double sweep = 0;
    for (std::uint64_t task = 0; task < stages.tasks().stages.front(); ++task) sweep += all.work(task);
    print_row(ranks, outcome, sweep, costs.triangles * sweep / costs.sweep);
  }
}

void run(const std::string& path, double iso, double error, std::int64_t block, bool open_border) {
  const VolumeOpener open = [&] { return open_volume(path); };
  MeshOptions options;
  options.iso = iso;
  options.error = Length::voxels(error);
  options.closed = !open_border;
  BlockOptions blocks;
  blocks.size = block;
  const Task task = resolve_blocks(RunKind::kBlocks, *open(), options, blocks, {}, {0, 0, 0});
  const BlockStages stages(task, blocks);
  const Costs costs = Measurement(open, task, stages).run();
  std::printf("%.0f triangles extracted; work of all blocks over a sweep's: %.2f\n", costs.triangles, [&] {
    double sum = 0;
    for (const TaskCost& cost : costs.tasks) sum += cost.work;
    return sum / costs.sweep;
  }());
  std::printf("| ranks | efficiency, %% | most work over mean | bytes sent per triangle |\n|---|---|---|---|\n");
  print_strong(stages, costs);
  std::printf("\ncopies of it, at least %d blocks a rank\n", kBlocksOfRank);
  print_weak(task.volume, options, blocks, stages, costs);
}

}  // namespace
}  // namespace isoweave

int main(int argc, char** argv) {
  if (argc < 5 || argc > 6 || (argc == 6 && std::strcmp(argv[5], "--open") != 0)) {
    std::fprintf(stderr, "bench_ranks VOLUME ISO ERROR BLOCK [--open]\n");
    return 2;
  }
  try {
    isoweave::run(argv[1], std::stod(argv[2]), std::stod(argv[3]), std::stoll(argv[4]), argc == 6);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_ranks: %s\n", error.what());
    return 1;
  }
}
