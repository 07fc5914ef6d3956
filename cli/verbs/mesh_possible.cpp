#include "verbs/mesh_possible.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <string_view>

#include "isoweave/generate.hpp"
#include "options/possible.hpp"
#include "options/preview.hpp"
#include "ranks.hpp"
#include "verbs/mesh_blocks.hpp"
#include "verbs/mesh_isos.hpp"

namespace isoweave::cli {
namespace {

// Stands for the page that will watch the run.
class NoObserver final : public SweepObserver {
 public:
  void add_final(std::span<const TriangleCorners>) override {}
  void end_slab(const Progress&, const SlabRecord&, const std::function<void(const Visitor&)>&) override {}
};

// The kind of a run, and the option that asks for it.
struct AskedKind {
  RunKind kind = RunKind::kMesh;
  std::string_view name;
};

AskedKind asked_kind(const MeshArguments& arguments) {
  const bool blocks = asked_blocks(arguments).has_value();
  const bool preview = arguments.preview.given();
  if (preview) preview_cell(arguments.preview, unknown_basis());  // finds errors in it now
  if (!arguments.labels.empty()) return {RunKind::kLabels, "--labels"};
  if (has_several_isos(arguments)) {
    constexpr std::string_view kName = "--iso with several values";
    if (!blocks && !preview) return {RunKind::kIsoValues, kName};
    throw std::invalid_argument(fmt::format("{}: expected a run without {}", kName, blocks ? "--blocks" : "--preview"));
  }
  if (preview && (blocks || rank_link() != nullptr)) {
    throw std::invalid_argument(fmt::format("--preview: expected a run without {}", blocks ? "--blocks" : "ranks"));
  }
  if (rank_link() != nullptr) return {RunKind::kBlocks, "isoweave-mpi"};
  if (blocks) return {RunKind::kBlocks, "--blocks"};
  if (preview) return {RunKind::kPreview, "--preview"};
  return {};
}

}  // namespace

// A volume, an index and an observer that are not the real ones stand for those that are opened later: only their
// presence counts.
void check_possible(const MeshArguments& arguments, const MeshOptions& options, const RunControl& control,
                    const std::optional<Checkpoint>& resume) {
  MeshOptions asked = options;
  RunControl with = control;
  if (!arguments.color_by.empty()) asked.values = generate_volume({});
  if (arguments.watch.given()) with.observer = std::make_shared<NoObserver>();
  if (arguments.index.named()) with.index = build_index(*generate_volume({"box", {1, 1, 1}}));
  // Ranks save results of blocks, not states.
  if (rank_link() == nullptr) with.checkpoint.folder = arguments.checkpoint;
  with.resume = resume;
  const auto [kind, name] = asked_kind(arguments);
  require_possible({kind, name, asked, with, arguments.stop, arguments.components});
}

}  // namespace isoweave::cli
