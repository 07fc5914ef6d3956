// One task of a mesh in blocks: from files to files.
#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "files/file_lock.hpp"
#include "isoweave/error.hpp"
#include "isoweave/tasks.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/block_worker.hpp"
#include "pipeline/parts/task_file.hpp"
#include "pipeline/parts/task_index.hpp"

namespace isoweave {
namespace {

class TaskRun {
 public:
  TaskRun(const TaskMesh& mesh, std::uint64_t number, const RunControl& control)
      : mesh_(mesh),
        number_(number),
        control_(control),
        task_(resolve_blocks(*mesh.open(), mesh.options, mesh.blocks, control, {0, 0, 0})),
        identity_{identity_of(task_), mesh.blocks.size, mesh.blocks.first},
        stages_(task_, mesh.blocks),
        tasks_(stages_.tasks()),
        stage_(tasks_.stage_of(number)),
        executor_(control.threads),
        worker_(task_, stages_.all, control_, executor_, report_,
                [this](Simplifier& simplifier, std::size_t level) { keep_final(simplifier, level); }),
        pieces_(task_.simplify.level_costs.size() + 1) {
    facts_.levels.resize(pieces_.size());
  }

  TaskEnd run() {
    if (has_rest(mesh_.folder, number_)) return TaskEnd::kDoneBefore;
    if (stage_ > 0 && !TaskIndex::is_complete(mesh_.folder, tasks_, stage_ - 1)) return TaskEnd::kTooEarly;
    const std::optional<FileLock> lock = FileLock::take(mesh_.folder + "/" + std::to_string(number_) + ".lock");
    if (!lock) return TaskEnd::kElsewhere;
    if (has_rest(mesh_.folder, number_)) return TaskEnd::kDoneBefore;
    work();
    return TaskEnd::kDone;
  }

 private:
  void work() {
    std::optional<ZonePart> rest = stage_ == 0 ? extract() : glue();
    std::vector<SplitPart> parts;
    if (rest && rest->triangles.size() > 0) parts = split(std::move(*rest));
    count(parts);
    require_unchanged(task_, identity_.run);
    write_final();
    write_rest(parts);
  }

  std::optional<ZonePart> extract() {
    const CellBox cells = stages_.grids[0].cells(stages_.block(0, number_), stages_.all);
    if (cells.empty()) return std::nullopt;
    SlabRecord record;
    return worker_.extract(mesh_.open(), cells, 0, record);
  }

  std::optional<ZonePart> glue() {
    const TaskIndex index(mesh_.folder, identity_, tasks_, stage_ - 1, facts_.levels.size());
    std::vector<ZonePart> parts;
    for (const std::uint64_t from : index.sources_of(number_)) {
      parts.push_back(index.read_part(from, number_, cut_part_shape(task_.simplify)));
    }
    if (parts.empty()) return std::nullopt;
    try {
      return worker_.glue(std::move(parts));
    } catch (const UnfitParts& unfit) {
      throw BadInput(mesh_.folder + ": the files for task " + std::to_string(number_) +
                     " do not fit together: " + unfit.what());
    }
  }

  std::vector<SplitPart> split(ZonePart rest) const {
    if (stage_ + 1 == tasks_.stages.size()) {
      throw std::logic_error(std::to_string(rest.triangles.size()) + " triangles are left undecided");
    }
    const std::uint64_t first = tasks_.first_of(stage_ + 1);
    const VertexNumbering& numbering = task_.simplify.zone.numbering;
    return split_part(std::move(rest), [&](std::uint64_t id) {
      const BlockIndex block = stages_.grids[stage_ + 1].block_of(numbering.place(id).low);
      return static_cast<std::size_t>(first + stages_.number(stage_ + 1, block));
    });
  }

  // Keeps what is final in a level until the task is done.
  void keep_final(Simplifier& simplifier, std::size_t level) {
    LevelCounts& counts = facts_.levels[level];
    FinalPiece piece;
    simplifier.final_source(level).take_final({(number_ << kPlaceBits) + counts.vertices, 0}, piece);
    counts.vertices += piece.positions.size();
    counts.triangles += piece.triangles.size();
    counts.open_edges += piece.open_edges;
    if (piece.positions.size() + piece.triangles.size() > 0) pieces_[level].push_back(std::move(piece));
  }

  void count(const std::vector<SplitPart>& parts) {
    const BlockTotals& totals = worker_.totals();
    TaskCounts& counts = facts_.counts;
    counts.cells = report_.cells_crossed;
    counts.triangles_extracted = report_.triangles_extracted;
    counts.vertices_extracted = report_.vertices_extracted;
    counts.taken = totals.triangles;
    counts.rounds = totals.rounds;
    counts.decisions = totals.decisions;
    counts.range = totals.range;
    for (std::size_t level = 0; level < pieces_.size(); ++level) facts_.levels[level].defects = totals.defects[level];
    for (const SplitPart& part : parts) {
      counts.left += part.part.triangles.size();
      facts_.parts.push_back({part.owner, part.part.triangles.size()});
    }
  }

  void write_final() const {
    StateWriter writer(final_file(mesh_.folder, number_));
    identity_.write(writer, number_);
    for (const std::vector<FinalPiece>& level : pieces_) {
      writer.value(static_cast<std::uint64_t>(level.size()));
      for (const FinalPiece& piece : level) write_final_piece(writer, piece);
    }
    writer.commit();
  }

  void write_rest(std::vector<SplitPart>& parts) const {
    StateWriter writer(rest_file(mesh_.folder, number_));
    identity_.write(writer, number_);
    facts_.write(writer);
    for (SplitPart& part : parts) write_part(writer, part.part);
    writer.commit();
  }

  const TaskMesh& mesh_;
  const std::uint64_t number_;
  const RunControl& control_;
  const Task task_;
  const TaskIdentity identity_;
  const BlockStages stages_;
  const TaskList tasks_;
  const std::size_t stage_;
  const Executor executor_;
  MeshReport report_;
  BlockWorker worker_;
  TaskFacts facts_;
  std::vector<std::vector<FinalPiece>> pieces_;  // per level
};

}  // namespace

TaskList list_tasks(const TaskMesh& mesh) {
  const Task task = resolve_blocks(*mesh.open(), mesh.options, mesh.blocks, {}, {0, 0, 0});
  return BlockStages(task, mesh.blocks).tasks();
}

TaskEnd do_task(const TaskMesh& mesh, std::uint64_t task, const RunControl& control) {
  const StandardFloats floats;
  return TaskRun(mesh, task, control).run();
}

bool is_done(const TaskMesh& mesh, std::uint64_t task) { return has_rest(mesh.folder, task); }

}  // namespace isoweave
