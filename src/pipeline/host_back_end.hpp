// Simplification on processors.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "output/final_output.hpp"
#include "output/full_output.hpp"
#include "pipeline/back_end.hpp"
#include "pipeline/task.hpp"

namespace isoweave {

class HostBackEnd final : public BackEnd {
 public:
  // Takes a sink for each level of the task. World, sinks and executor must outlive the back end. stop: unless null,
  // simplify() throws Interrupted once it is set. Of the control, schedule, measure and observer count. head_start: of
  // a run to a number of triangles; overshot() tells where it was too high, or has counted.
  HostBackEnd(const SimplifyTask& task, const World& world, std::span<MeshSink* const> sinks, const Executor& executor,
              const RunControl& control, const std::atomic<bool>* stop, const HeadStart& head_start = {});

  void simplify(const SurfacePiece& piece, bool complete, SlabRecord& record) override;
  void write(const SurfacePiece& piece, SlabRecord& record, MeshReport& report) override;
  std::optional<HeadStart> overshot() const override { return overshot_; }
  Held held() const override;
  void view_undecided(const SweepObserver::Visitor& visitor) const override;
  void wait_for_sinks() override;
  void finish(MeshReport& report) const override;
  std::uint64_t inherited() const override;
  void serialize(StateWriter& state) const override;
  void serialize(StateReader& state) override;

  // Counts removed triangles by the keys of the decisions, from now on, and tells the counts.
  void count_removed() { simplifier_.count_removed(); }
  CostHistogram removed_by_key() const { return simplifier_.removed_by_key(); }

 private:
  bool counts() const { return target_ && target_->head_start().counts > 0; }
  void decide_to_number(bool complete);
  std::uint64_t waiting_triangles() const;

  const SimplifyTask task_;
  const World& world_;
  const Executor& executor_;
  Simplifier simplifier_;
  std::optional<CountTarget> target_;
  bool hands_out_ = true;                              // final triangles
  std::optional<HeadStart> overshot_{};                // see overshot()
  std::vector<std::unique_ptr<FinalOutput>> outputs_;  // per level
  FullOutput full_output_;
  std::uint64_t zone_bytes_ = 0;  // with the last piece
  std::uint64_t waiting_ = 0;     // triangles, see Held
};

}  // namespace isoweave
