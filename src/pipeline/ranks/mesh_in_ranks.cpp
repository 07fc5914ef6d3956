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
#include "pipeline/parts/task_folder.hpp"
#include "pipeline/parts/waiting_part.hpp"
#include "pipeline/ranks/rank_messages.hpp"
#include "pipeline/ranks/rank_plan.hpp"
#include "pipeline/ranks/result_writer.hpp"
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
        task_(resolve_blocks(RunKind::kProcesses, *open(), options, ranks.blocks, control, {0, 0, 0})),
        identity_{identity_of(task_), ranks.blocks.size, ranks.blocks.first},
        stages_(task_, ranks.blocks),
        tasks_(stages_.tasks()),
        executor_(control.threads) {
    if (!ranks.blocks.folder.empty()) scratch_.emplace(ranks.blocks.folder);
    if (is_first()) {
      collector_.emplace(task_, stages_, sinks, control_, executor_, task_.volume.path);
      results_.emplace(*collector_);
    }
  }

  MeshReport run() {
    Stopwatch total;
    share_out();
    while (work_.tasks < own_) {
      take_messages();
      ready_.empty() ? wait() : work_on_next();
    }
    require_unchanged(task_, identity_.run);
    if (!is_first()) return end_elsewhere();
    MeshReport report = complete();
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
    for (std::uint64_t task = 0; task < tasks_.count(); ++task) {
      if (owner(task) != link_.rank()) continue;
      ++own_;
      if (tasks_.stage_of(task) == 0) ready_.insert(task);
    }
  }

  void send_weights() {
    MessageWriter message(MessageKind::kWeights);
    message.list(weights_);
    send(0, message.take());
  }

  void plan() {
    while (weighed_ < link_.ranks()) wait();
    owners_ = plan_ranks(stages_, weights_, link_.ranks());
    for (int rank = 1; rank < link_.ranks(); ++rank) {
      MessageWriter message(MessageKind::kPlan);
      message.list(owners_);
      send(rank, message.take());
    }
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
    hand_in(task, result.facts, std::move(result.pieces));
  }

  bool is_kept(std::uint64_t task) const { return !options_.results.empty() && has_result(options_.results, task); }

  TaskResult kept_result(std::uint64_t task) {
    parts_.erase(task);
    return read_result(options_.results, identity_, task, cut_part_shape(task_.simplify));
  }

  TaskResult work(std::uint64_t task) {
    TaskResult result = tasks_.stage_of(task) == 0 ? extract(task) : glue(task);
    // Where no parts have come there is nothing to keep.
    const bool is_worth_it = tasks_.stage_of(task) == 0 || result.facts.counts.taken > 0;
    if (is_worth_it && !options_.results.empty()) write_result(options_.results, identity_, task, result);
    return result;
  }

  TaskResult extract(std::uint64_t task) {
    return TaskWork(task_, stages_, task, control_, executor_, [this] { take_messages(); }).extract(open_);
  }

  TaskResult glue(std::uint64_t task) {
    std::vector<ZonePart> parts;
    if (const auto waiting = parts_.extract(task)) {
      for (WaitingPart& part : waiting.mapped()) parts.push_back(part.take(cut_part_shape(task_.simplify)));
    }
    return TaskWork(task_, stages_, task, control_, executor_, [this] { take_messages(); }).glue(std::move(parts));
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
  void hand_in(std::uint64_t task, const TaskFacts& facts, std::vector<std::vector<FinalPiece>> pieces) {
    if (is_first()) return take_result(task, facts, std::move(pieces));
    MessageWriter message(MessageKind::kResult);
    message.value(task);
    facts.write(message);
    for (const std::vector<FinalPiece>& level : pieces) write_final_pieces(message, level);
    send(0, message.take());
  }

  void take_result(std::uint64_t task, const TaskFacts& facts, std::vector<std::vector<FinalPiece>> pieces) {
    results_->take(task, facts, std::move(pieces));
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
    TaskFacts facts;
    message.value(task);
    message.require(is_first() && task < tasks_.count(), "a task of this mesh");
    facts.read(message, levels());
    std::vector<std::vector<FinalPiece>> pieces(levels());
    for (std::vector<FinalPiece>& level : pieces) read_final_pieces(message, level);
    take_result(task, facts, std::move(pieces));
  }

  RankWork& rank_work(int rank) {
    all_work_.resize(to_size(link_.ranks()));
    return all_work_.at(to_size(rank));
  }

  MeshReport end_elsewhere() {
    work_.peak_bytes = system::peak_bytes();
    MessageWriter message(MessageKind::kDone);
    message.value(work_);
    send(0, message.take());
    while (!ended_) wait();
    return {};
  }

  // Completes the mesh, when all ranks are done.
  MeshReport complete() {
    while (results_->tasks() < tasks_.count() || ranks_done_ + 1 < link_.ranks()) wait();
    if (results_->waits()) throw BadInput(task_.volume.path + ": final triangles of ranks do not fit together");
    collector_->check_counts();
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
  const Task task_;
  const TaskIdentity identity_;
  const BlockStages stages_;
  const TaskList tasks_;
  const Executor executor_;
  std::optional<TaskCollector> collector_;  // of rank 0
  std::optional<ResultWriter> results_;
  std::vector<std::uint64_t> weights_;            // per task of the first stage
  std::vector<std::uint32_t> owners_;             // per task
  int weighed_ = 1;                               // ranks, this one included
  std::uint64_t own_ = 0;                         // tasks of this rank
  std::set<std::uint64_t> ready_;                 // all parts for them are here
  std::map<std::uint64_t, std::size_t> arrived_;  // per task that is not ready: messages from the stage before
  std::optional<PartScratch> scratch_;
  std::map<std::uint64_t, std::vector<WaitingPart>> parts_;
  RankWork work_;
  std::vector<RankWork> all_work_;
  int ranks_done_ = 0;  // others
  bool ended_ = false;
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
