// The main job by ranks: parts go by messages to the ranks that own the blocks of the next stage.
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "isoweave/error.hpp"
#include "isoweave/ranks.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/parts/blocks_to_number.hpp"
#include "pipeline/parts/task_folder.hpp"
#include "pipeline/parts/waiting_part.hpp"
#include "pipeline/ranks/rank_messages.hpp"
#include "pipeline/ranks/rank_plan.hpp"
#include "pipeline/ranks/result_writer.hpp"
#include "pipeline/ranks/results_folder.hpp"
#include "pipeline/run_report.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

// The run has failed, here or elsewhere: rank 0 has said so to all.
struct RunFailed {
  RankError error;
};

class RanksRun {
 public:
  RanksRun(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
           const RankOptions& ranks, RankLink& link, const RunControl& control)
      : open_(open),
        options_(ranks),
        link_(link),
        control_(control),
        mesh_options_(options),
        task_(resolve_blocks(RunKind::kBlocks, *open(), options, ranks.blocks, control, {0, 0, 0})),
        identity_{identity_of(task_), ranks.blocks.size, ranks.blocks.first},
        stages_(task_, ranks.blocks),
        tasks_(stages_.tasks()),
        executor_(control.threads),
        sinks_(sinks) {
    if (!ranks.blocks.folder.empty()) scratch_.emplace(ranks.blocks.folder);
  }

  MeshReport run() {
    Stopwatch total;
    share_out();
    while (true) {
      work_on_all();
      if (is_first() ? completed() : ended()) break;
    }
    if (!is_first()) return {};
    MeshReport report = finish();
    total.lap(report.seconds_total);
    return report;
  }

 private:
  bool is_first() const { return link_.rank() == 0; }
  std::size_t levels() const { return task_.simplify.level_costs.size() + 1; }
  int owner(std::uint64_t task) const { return static_cast<int>(owners_[to_size(task)]); }

  void send(int to, std::vector<std::byte> message) {
    ++work_.messages;
    work_.bytes_sent += message.size();
    link_.send(to, std::move(message));
  }

  // Gives each task to a rank. Every rank looks at some of the blocks, to tell how much work they are.
  void share_out() {
    weights_.assign(to_size(tasks_.stages.front()), 0);
    for (std::size_t n = to_size(link_.rank()); n < weights_.size(); n += to_size(link_.ranks())) {
      check_stop(control_);
      const CellBox cells = stages_.grids[0].cells(stages_.block(0, n), stages_.all);
      weights_[n] = is_kept(n) ? 1 : block_weight(open_, cells, task_);
      take_messages();
    }
    is_first() ? plan() : send_weights();
    while (owners_.empty()) wait();
  }

  void send_weights() {
    MessageWriter message(MessageKind::kWeights);
    message.list(weights_);
    send(0, message.take());
  }

  void plan() {
    const std::optional<TaskIdentity> before = identity_of_results(options_.results);
    begin_with(before ? before->head_start : head_start_of(open_, mesh_options_, control_));
    while (weighed_ < link_.ranks()) wait();
    owners_ = plan_ranks(stages_, weights_, link_.ranks());
    for (int rank = 1; rank < link_.ranks(); ++rank) {
      MessageWriter message(MessageKind::kPlan);
      message.value(identity_.head_start);
      message.list(owners_);
      send(rank, message.take());
    }
  }

  // Makes ready for results of tasks that decide up to the cost of a head start.
  void begin_with(CostBits head_start) {
    identity_.head_start = head_start;
    collector_.emplace(task_, head_start, stages_, sinks_, control_, executor_, task_.volume.path,
                       options_.blocks.folder);
    results_.emplace(*collector_);
  }

  // Works on all tasks of this rank.
  void work_on_all() {
    std::uint64_t left = 0;
    for (std::uint64_t task = 0; task < tasks_.count(); ++task) {
      if (owner(task) != link_.rank()) continue;
      ++left;
      if (tasks_.stage_of(task) == 0) ready_.insert(task);
    }
    while (left > 0) {
      take_messages();
      if (ready_.empty()) {
        wait();
      } else {
        work_on_next();
        --left;
      }
    }
    require_unchanged(task_, identity_.run);
  }

  // Takes the first task that can be done, from the results that are kept or by working on it.
  void work_on_next() {
    check_stop(control_);
    check_memory_of_blocks(task_, control_, stages_.grids[0].size);
    const std::uint64_t task = ready_.extract(ready_.begin()).value();
    TaskResult result = is_kept(task) ? kept_result(task) : work(task);
    ++work_.tasks;
    work_.triangles += result.facts.counts.taken;
    hand_on(task, std::move(result.parts));
    hand_in(task, std::move(result));
  }

  bool is_kept(std::uint64_t task) const { return !options_.results.empty() && has_result(options_.results, task); }

  TaskResult kept_result(std::uint64_t task) {
    parts_.erase(task);
    return TaskFolder(options_.results, identity_, task_.simplify).result(task);
  }

  TaskResult work(std::uint64_t task) {
    TaskResult result = tasks_.stage_of(task) == 0 ? extract(task) : glue(task);
    // Where no parts have come there is nothing to keep.
    const bool is_worth_it = tasks_.stage_of(task) == 0 || result.facts.counts.taken > 0;
    if (is_worth_it && !options_.results.empty()) write_result(options_.results, identity_, task, result);
    return result;
  }

  TaskResult extract(std::uint64_t task) { return work_of(task).extract(open_); }

  TaskResult glue(std::uint64_t task) {
    std::vector<ZonePart> parts;
    if (const auto waiting = parts_.extract(task)) {
      for (WaitingPart& part : waiting.mapped()) parts.push_back(part.take(cut_part_shape(task_.simplify)));
    }
    return work_of(task).glue(std::move(parts));
  }

  TaskWork work_of(std::uint64_t task) {
    const CostBits limit = limit_of_tasks(task_.simplify, identity_.head_start);
    return TaskWork(task_, limit, stages_, task, control_, executor_, [this] { take_messages(); });
  }

  // Sends every task of the next stage that waits for it what a task has left for it, or that this is nothing.
  void hand_on(std::uint64_t task, std::vector<SplitPart> parts) {
    auto part = parts.begin();
    for (const std::uint64_t taker : stages_.takers_of(task)) {
      std::optional<ZonePart> left;
      if (part != parts.end() && part->owner == taker) left = std::move((part++)->part);
      if (owner(taker) == link_.rank()) {
        take_part(taker, std::move(left));
      } else {
        send_part(taker, std::move(left));
      }
    }
  }

  void send_part(std::uint64_t taker, std::optional<ZonePart> part) {
    MessageWriter message(MessageKind::kPart);
    message.value(taker);
    message.value(static_cast<std::uint32_t>(part.has_value()));
    if (part) write_part(message, *part);
    send(owner(taker), message.take());
  }

  void take_part(std::uint64_t task, std::optional<ZonePart> part) {
    if (part && scratch_) {
      parts_[task].emplace_back(std::move(*part), *scratch_);
    } else if (part) {
      parts_[task].emplace_back(std::move(*part));
    }
    if (++arrived_[task] < stages_.givers_of(task).size()) return;
    arrived_.erase(task);
    ready_.insert(task);
  }

  // Gives rank 0 the final triangles of a task and its counts.
  void hand_in(std::uint64_t task, TaskResult result) {
    if (is_first()) return take_result(task, std::move(result));
    MessageWriter message(MessageKind::kResult);
    message.value(task);
    result.facts.write(message);
    result.write_mesh(message);
    send(0, message.take());
  }

  void take_result(std::uint64_t task, TaskResult result) {
    results_->take(task, std::move(result));
    if (!control_.progress) return;
    const auto done = static_cast<std::int64_t>(results_->tasks());
    const auto all = static_cast<std::int64_t>(tasks_.count());
    const double share = static_cast<double>(done) / static_cast<double>(all);
    const double voxels = static_cast<double>(task_.volume.slice_samples()) * static_cast<double>(task_.volume.dims[2]);
    control_.progress(
        {done, all, static_cast<std::uint64_t>(voxels * share), 0, collector_->triangles(), system::resident_bytes()});
  }

  void wait() {
    check_stop(control_);
    Stopwatch clock;
    link_.pause();
    clock.lap(work_.seconds_waiting);
    take_messages();
  }

  void take_messages() {
    while (std::optional<RankMessage> message = link_.receive()) take(MessageReader(std::move(*message)));
  }

  void take(MessageReader message) {
    switch (message.kind()) {
      case MessageKind::kWeights:
        return take_weights(message);
      case MessageKind::kPlan:
        message.value(identity_.head_start);
        message.list(owners_);
        return message.require(owners_.size() == tasks_.count(), "a rank for each task");
      case MessageKind::kPart:
        return read_part(message);
      case MessageKind::kResult:
        return read_result_of(message);
      case MessageKind::kDone: {
        ++ranks_done_;
        return message.value(rank_work(message.from()));
      }
      case MessageKind::kAgain:
        again_ = true;
        return message.value(identity_.head_start);
      case MessageKind::kFailed: {
        RunFailed failed;
        failed.error.read(message);
        throw failed;
      }
      case MessageKind::kEnd:
        ended_ = true;
        return;
    }
    message.require(false, "a kind of message that there is");
  }

  void take_weights(MessageReader& message) {
    std::vector<std::uint64_t> weights;
    message.list(weights);
    message.require(weights.size() == weights_.size(), "the blocks of this mesh");
    for (std::size_t n = 0; n < weights.size(); ++n) weights_[n] += weights[n];
    ++weighed_;
  }

  void read_part(MessageReader& message) {
    std::uint64_t task = 0;
    std::uint32_t has_part = 0;
    message.value(task);
    message.value(has_part);
    // Another rank may have learnt the plan and done a task before it is known here.
    message.require(task < tasks_.count() && (owners_.empty() || owner(task) == link_.rank()), "a task of this rank");
    std::optional<ZonePart> part;
    if (has_part != 0) part = read_cut_part(message, cut_part_shape(task_.simplify));
    take_part(task, std::move(part));
  }

  void read_result_of(MessageReader& message) {
    std::uint64_t task = 0;
    TaskResult result;
    message.value(task);
    message.require(is_first() && task < tasks_.count(), "a task of this mesh");
    result.facts.read(message, levels());
    result.read_mesh(message, cut_part_shape(task_.simplify), task_.simplify.goal.given());
    take_result(task, std::move(result));
  }

  RankWork& rank_work(int rank) {
    all_work_.resize(to_size(link_.ranks()));
    return all_work_.at(to_size(rank));
  }

  // Tells rank 0 that all tasks here are done. Returns whether the run has ended: else all are to be done again.
  bool ended() {
    again_ = false;
    work_.peak_bytes = system::peak_bytes();
    MessageWriter message(MessageKind::kDone);
    message.value(work_);
    send(0, message.take());
    while (!ended_ && !again_) wait();
    return ended_;
  }

  // Completes the mesh, when all ranks are done. Returns whether it is complete: else all tasks are to be done again.
  bool completed() {
    while (results_->tasks() < tasks_.count() || ranks_done_ + 1 < link_.ranks()) wait();
    if (results_->waits()) throw BadInput(task_.volume.path + ": final triangles of ranks do not fit together");
    collector_->check_counts();
    if (!task_.simplify.goal.given()) return true;
    const std::optional<CostBits> lower = collector_->end_at_number();
    if (lower) begin_again(*lower);
    return !lower;
  }

  void begin_again(CostBits head_start) {
    if (!options_.results.empty()) remove_results(options_.results);
    ranks_done_ = 0;
    begin_with(head_start);
    for (int rank = 1; rank < link_.ranks(); ++rank) {
      MessageWriter message(MessageKind::kAgain);
      message.value(head_start);
      send(rank, message.take());
    }
  }

  MeshReport finish() {
    MeshReport report = collector_->finish();
    work_.peak_bytes = report.peak_bytes;
    rank_work(0) = work_;
    report.ranks = std::move(all_work_);
    for (int rank = 1; rank < link_.ranks(); ++rank) send(rank, MessageWriter(MessageKind::kEnd).take());
    return report;
  }

  const VolumeOpener& open_;
  const RankOptions& options_;
  RankLink& link_;
  const RunControl& control_;
  const MeshOptions& mesh_options_;
  const Task task_;
  TaskIdentity identity_;
  const BlockStages stages_;
  const TaskList tasks_;
  const Executor executor_;
  const std::span<MeshSink* const> sinks_;  // of rank 0
  std::optional<TaskCollector> collector_;
  std::optional<ResultWriter> results_;
  std::vector<std::uint64_t> weights_;            // per task of the first stage
  std::vector<std::uint32_t> owners_;             // per task
  int weighed_ = 1;                               // ranks, this one included
  std::set<std::uint64_t> ready_;                 // all parts for them are here
  std::map<std::uint64_t, std::size_t> arrived_;  // per task that is not ready: messages from the stage before
  std::optional<PartScratch> scratch_;
  std::map<std::uint64_t, std::vector<WaitingPart>> parts_;
  RankWork work_;
  std::vector<RankWork> all_work_;
  int ranks_done_ = 0;  // others
  bool ended_ = false, again_ = false;
};

MeshReport run(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
               const RankOptions& ranks, RankLink& link, const RunControl& control) {
  std::optional<RankError> error;
  try {
    if (link.rank() == 0) check_sinks(sinks, options.levels.size());
    return RanksRun(open, sinks, options, ranks, link, control).run();
  } catch (const RunFailed& failed) {
    error = failed.error;
    if (link.rank() == 0) tell_all(link, *error);
  } catch (const std::exception& own) {
    error = agreed_error(link, RankError::of(own));
  }
  error->raise();
}

}  // namespace

MeshReport mesh_in_ranks(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
                         const RankOptions& ranks, RankLink& link, const RunControl& control) {
  const StandardFloats floats;
  return run(open, sinks, options, ranks, link, control);
}

void end_ranks(RankLink& link, const std::exception& error) { agreed_error(link, RankError::of(error)).raise(); }

}  // namespace isoweave
