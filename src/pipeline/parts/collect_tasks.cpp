// The meshes out of the files of all tasks.
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/tasks.hpp"
#include "output/final_output.hpp"
#include "output/world.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/task_file.hpp"
#include "pipeline/run_report.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

// A piece that has been read, as a source of final triangles. It has labels for all vertices, which are never too many.
class ReadPiece final : public FinalSource {
 public:
  FinalPiece& piece() { return piece_; }

  void take_final(const Receipt&, FinalPiece& piece) override { std::swap(piece, piece_); }
  std::size_t held_vertices() const override { return std::numeric_limits<std::size_t>::max(); }
  void change_labels(const std::function<void(std::span<std::uint32_t*>)>&) override {}

 private:
  FinalPiece piece_;
};

class CollectRun {
 public:
  CollectRun(const TaskMesh& mesh, std::span<MeshSink* const> sinks, const RunControl& control)
      : mesh_(mesh),
        control_(control),
        task_(resolve_blocks(*mesh.open(), mesh.options, mesh.blocks, control, {0, 0, 0})),
        identity_{identity_of(task_), mesh.blocks.size, mesh.blocks.first},
        tasks_(BlockStages(task_, mesh.blocks).tasks()),
        executor_(control.threads),
        world_(task_.volume.geometry, task_.space, common_offset(sinks)),
        sinks_(sinks.begin(), sinks.end()),
        firsts_(sinks.size()) {
    task_.offset = common_offset(sinks);
    for (MeshSink* sink : sinks_) {
      outputs_.push_back(std::make_unique<FinalOutput>(world_, *sink, executor_, control.measure));
    }
  }

  MeshReport run() {
    Stopwatch total;
    report_.threads = executor_.threads();
    report_errors(task_.simplify, report_);
    warn_of_space(task_, report_);
    warn_of_rounding(task_, report_);
    report_.blocks.resize(tasks_.stages.size());
    for (std::uint64_t task = 0; task < tasks_.count(); ++task) read_facts(task);
    check_counts();
    for (std::uint64_t task = 0; task < tasks_.count(); ++task) write(task);
    finish_report();
    for (MeshSink* sink : sinks_) sink->finish();
    total.lap(report_.seconds_total);
    report_.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

 private:
  void read_facts(std::uint64_t task) {
    if (!has_rest(mesh_.folder, task)) {
      throw BadInput(mesh_.folder + ": expected all " + std::to_string(tasks_.count()) +
                     " tasks to be done, found task " + std::to_string(task) + " undone");
    }
    StateReader reader(rest_file(mesh_.folder, task), "file of a task");
    identity_.require(reader, task);
    TaskFacts facts;
    facts.read(reader, sinks_.size());
    for (std::size_t level = 0; level < sinks_.size(); ++level) {
      firsts_[level].push_back(vertices_[level]);
      vertices_[level] += facts.levels[level].vertices;
      triangles_[level] += facts.levels[level].triangles;
      defects_[level] += facts.levels[level].defects;
    }
    add(facts.counts, tasks_.stage_of(task));
  }

  void add(const TaskCounts& counts, std::size_t stage) {
    report_.cells_crossed += counts.cells;
    report_.triangles_extracted += counts.triangles_extracted;
    report_.vertices_extracted += counts.vertices_extracted;
    report_.rounds += counts.rounds;
    report_.blocks[stage].blocks += static_cast<std::uint64_t>(counts.taken > 0);
    report_.blocks[stage].triangles += counts.taken;
    decisions_ += counts.decisions;
    range_.merge(counts.range);
    left_.push_back(counts.left);
  }

  // Every triangle that was extracted has been removed or handed over, and what a stage has left the next one has
  // taken.
  void check_counts() const {
    const std::uint64_t expected = report_.triangles_extracted - decisions_.removed;
    if (triangles_.back() != expected) refuse("triangles", expected, triangles_.back());
    std::uint64_t task = 0;
    for (std::size_t stage = 0; stage + 1 < tasks_.stages.size(); ++stage) {
      std::uint64_t left = 0;
      for (std::uint64_t n = 0; n < tasks_.stages[stage]; ++n) left += left_[static_cast<std::size_t>(task++)];
      if (left != report_.blocks[stage + 1].triangles) {
        refuse("triangles that a stage takes over", left, report_.blocks[stage + 1].triangles);
      }
    }
    if (control_.measure && vertices_.back() >= std::numeric_limits<std::uint32_t>::max()) {
      throw OverMemory(mesh_.folder + ": expected fewer than 2^32 vertices where components are counted, found " +
                       std::to_string(vertices_.back()));
    }
  }

  [[noreturn]] void refuse(const char* what, std::uint64_t expected, std::uint64_t found) const {
    throw BadInput(mesh_.folder + ": the files of the tasks do not fit together: expected " + std::to_string(expected) +
                   ' ' + what + ", found " + std::to_string(found));
  }

  void write(std::uint64_t task) {
    check_stop(control_);
    StateReader reader(final_file(mesh_.folder, task), "file of a task");
    identity_.require(reader, task);
    for (std::size_t level = 0; level < outputs_.size(); ++level) {
      const std::size_t pieces = reader.count(1);
      for (std::size_t n = 0; n < pieces; ++n) write_piece(reader, task, level);
    }
    reader.require_end();
  }

  void write_piece(StateReader& reader, std::uint64_t task, std::size_t level) {
    ReadPiece source;
    read_final_piece(reader, source.piece());
    for (KnownVertex& vertex : source.piece().known) {
      const std::uint64_t from = vertex.receipt.number >> kPlaceBits;
      const std::uint64_t place = vertex.receipt.number & ((std::uint64_t{1} << kPlaceBits) - 1);
      reader.require(
          from <= task && firsts_[level][static_cast<std::size_t>(from)] + place < outputs_[level]->end().number,
          "vertices that have been handed over");
      vertex.receipt.number = firsts_[level][static_cast<std::size_t>(from)] + place;
      vertex.receipt.label = static_cast<std::uint32_t>(vertex.receipt.number);
    }
    outputs_[level]->take(source);
  }

  void finish_report() {
    for (const auto& output : outputs_) output->wait();
    for (std::size_t level = 0; level < outputs_.size(); ++level) {
      SurfaceReport& mesh = level + 1 == outputs_.size() ? report_ : report_.levels[level];
      outputs_[level]->report(mesh);
      report_defects(defects_[level], mesh);
    }
    report_decisions(decisions_, report_);
    report_samples(task_.volume, range_, report_);
    for (std::size_t stage = 0; stage < report_.blocks.size(); ++stage) {
      report_.blocks[stage].size = BlockStages(task_, mesh_.blocks).grids[stage].size;
    }
    while (report_.blocks.size() > 1 && report_.blocks.back().blocks == 0) report_.blocks.pop_back();
    warn_of_border(task_, report_);
    warn_of_nothing(task_, control_.allow_empty, report_);
  }

  const TaskMesh& mesh_;
  const RunControl& control_;
  Task task_;
  const TaskIdentity identity_;
  const TaskList tasks_;
  const Executor executor_;
  const World world_;
  const std::vector<MeshSink*> sinks_;
  std::vector<std::vector<std::uint64_t>> firsts_;  // per level and task: the number of its first vertex
  std::vector<std::uint64_t> vertices_ = std::vector<std::uint64_t>(firsts_.size(), 0);  // per level
  std::vector<std::uint64_t> triangles_ = vertices_;
  std::vector<SurfaceDefects> defects_ = std::vector<SurfaceDefects>(firsts_.size());
  std::vector<std::uint64_t> left_;  // triangles, per task
  std::vector<std::unique_ptr<FinalOutput>> outputs_;
  MeshReport report_;
  DecisionCounts decisions_;
  SampleRange range_;
};

}  // namespace

MeshReport collect_tasks(const TaskMesh& mesh, std::span<MeshSink* const> sinks, const RunControl& control) {
  const StandardFloats floats;
  check_sinks(sinks, mesh.options.levels.size());
  return CollectRun(mesh, sinks, control).run();
}

}  // namespace isoweave
