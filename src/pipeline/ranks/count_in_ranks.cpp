// The triangles of a full surface, counted by ranks: each counts those of every n-th block.
#include <cstdint>
#include <utility>

#include "isoweave/ranks.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/block_worker.hpp"
#include "pipeline/ranks/rank_messages.hpp"

namespace isoweave {
namespace {

std::uint64_t count_own(const VolumeOpener& open, const SurfaceOptions& options, const BlockOptions& blocks,
                        const RankLink& link, const RunControl& control) {
  const Task task = resolve_blocks(RunKind::kBlocks, *open(), full_surface(options), blocks, control, {0, 0, 0});
  const BlockStages stages(task, blocks);
  const Executor executor(control.threads);
  MeshReport report;
  BlockWorker worker(task, kUnknownCost, stages.all, control, executor, report, {});
  const std::uint64_t count = stages.tasks().stages.front();
  for (auto n = static_cast<std::uint64_t>(link.rank()); n < count; n += static_cast<std::uint64_t>(link.ranks())) {
    check_stop(control);
    const CellBox cells = stages.grids[0].cells(stages.block(0, n), stages.all);
    if (!cells.empty()) worker.count(open(), cells);
  }
  return report.triangles_extracted;
}

void send_count(RankLink& link, int to, std::uint64_t count) {
  MessageWriter message(MessageKind::kCount);
  message.value(count);
  link.send(to, message.take());
}

std::uint64_t receive_count(RankLink& link, const RunControl& control) {
  while (true) {
    check_stop(control);
    std::optional<RankMessage> received = link.receive();
    if (!received) {
      link.pause();
      continue;
    }
    MessageReader message(std::move(*received));
    if (message.kind() == MessageKind::kFailed) throw RunFailed::read(message);
    message.require(message.kind() == MessageKind::kCount, "a count of triangles");
    std::uint64_t count = 0;
    message.value(count);
    return count;
  }
}

std::uint64_t sum_of_ranks(std::uint64_t own, RankLink& link, const RunControl& control) {
  if (link.rank() > 0) {
    send_count(link, 0, own);
    return receive_count(link, control);
  }
  for (int rank = 1; rank < link.ranks(); ++rank) own += receive_count(link, control);
  for (int rank = 1; rank < link.ranks(); ++rank) send_count(link, rank, own);
  return own;
}

}  // namespace

std::uint64_t count_triangles_in_ranks(const VolumeOpener& open, const SurfaceOptions& options,
                                       const BlockOptions& blocks, RankLink& link, const RunControl& control) {
  const StandardFloats floats;
  return run_together(link,
                      [&] { return sum_of_ranks(count_own(open, options, blocks, link, control), link, control); });
}

}  // namespace isoweave
