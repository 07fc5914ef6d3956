// The algorithms that the paper compares itself with, and isoweave, on one surface: what bench/paper measures.
//
//   bench_baselines VOLUME ISO ERROR METHOD MESH.ply [LAYERS]
//
// ERROR is in mean voxels. The surface is open. METHOD is one of these:
//
//   queue         the complete surface, then one priority queue: the reference
//   isoweave:T    slabs of T layers; an edge is decided when it is safe (docs/determinism.md)
//   tandem:L      layer by layer with a time lag of L layers, and no rule about neighbours
//   frozen:T      slabs of T layers, each simplified by itself; vertices on the slices between them stay where they are
//
// LAYERS: the sweep stops after so many layers (for frozen, a multiple of T), and the mesh is the surface as it is
// then. Prints JSON: counts, the triangles that a sweep holds when it stops, the most at a time, and the digest.
//
// All methods have the extractor, the quadrics, the keys and the legality of the library. They differ in which edge may
// be decided when, and in nothing else. Tandem decides, after each layer and in the order of the keys, the edges that
// have no end on the front and cost no more than (E * g)^2, where E is the error and g = min(1, d / L) for an edge
// whose nearer end is d layers from the front; L = 0 stands for g = 1. An edge above that waits for later layers. This
// is what the paper tells of the tandem algorithm (Attali, Cohen-Steiner and Edelsbrunner, 2005): layer by layer, a
// time lag, an error that falls off towards the front. How theirs falls off is not known here, so it is no copy of
// theirs.
//
// Queue, tandem and frozen hold the complete surface and go by layers as a sweep would: an edge both of whose ends have
// all their triangles has the stars that it would have in a sweep. Its key comes from the quadrics of both ends, also
// where one of the ends got its last triangles after the other one had moved.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "extract/make_extractor.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "output/final_output.hpp"
#include "output/world.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/surface_field.hpp"
#include "pipeline/task.hpp"
#include "simplify/hand_over.hpp"
#include "simplify/queue.hpp"
#include "simplify/radix_heap.hpp"
#include "simplify/simplifier.hpp"

namespace {

using namespace isoweave;

struct Arguments {
  std::string volume, method, mesh;
  std::int64_t layers_of_method = 0;  // T or L
  MeshOptions options;
  std::int64_t until = std::numeric_limits<std::int64_t>::max();  // layers
};

// The pieces of a volume's surface, some layers at a time. The layer below the first slice comes with the first piece:
// an open surface has nothing there.
class Pieces {
 public:
  Pieces(SliceSource& source, const Task& task, std::int64_t until, const Executor& executor)
      : field_(source, task.surface, executor, false),
        extractor_(make_extractor(task.surface.extractor, field_.info(), {field_.rule(), false}, executor)),
        window_(field_.source(), extractor_->slices_for(1).first),
        all_(extractor_->layers_left() - 1),
        last_(std::min(all_, until)) {}

  std::int64_t done() const { return all_ - extractor_->layers_left(); }
  bool complete() const { return last_ == all_; }

  // Returns null where no layer is left.
  const SurfacePiece* next(std::int64_t layers) {
    if (done() == last_) return nullptr;
    const std::int64_t count = std::min(layers, last_ - std::max<std::int64_t>(done(), 0)) + (done() < 0 ? 1 : 0);
    const auto [first, end] = extractor_->slices_for(count);
    window_.advance(first, end);
    extractor_->extract(window_, count, ~std::uint64_t{0}, piece_);
    return &piece_;
  }

 private:
  SurfaceField field_;
  std::unique_ptr<Extractor> extractor_;
  SliceWindow window_;
  std::int64_t all_, last_;
  SurfacePiece piece_;
};

// The counts of a run beside those of the mesh.
struct Outcome {
  std::uint64_t extracted = 0;
  std::uint64_t most_held = 0;
  std::uint64_t held = 0;  // when the sweep stops; 0 of a method that holds the complete surface, or nothing
  std::uint64_t collapses = 0;
};

// Hands over all triangles of a zone, also those that are not final.
class AllTriangles final : public FinalSource {
 public:
  AllTriangles(Zone& zone, const Executor& executor) : zone_(zone), hand_over_(zone, 0, false, executor) {}

  void take_final(const Receipt& first, FinalPiece& piece) override {
    std::vector<Index> triangles;
    for (Index t = 0; t < zone_.triangle_count(); ++t) {
      if (zone_.alive(half_edge(t, 0))) triangles.push_back(t);
    }
    hand_over_.fill(triangles, first, piece);
  }
  std::size_t held_vertices() const override { return zone_.vertices.size(); }
  void change_labels(const std::function<void(std::span<std::uint32_t*>)>& change) override {
    hand_over_.change_labels(change);
  }

 private:
  Zone& zone_;
  HandOver hand_over_;
};

// The complete surface in one zone. Nothing is removed from it, so the triangles of a layer follow one another.
class CompleteSurface {
 public:
  CompleteSurface(const ZoneOptions& options, Pieces& pieces, const Executor& executor) : zone(options) {
    while (const SurfacePiece* piece = pieces.next(1)) {
      zone.append(*piece, executor);
      zone.settle_edges(executor);
      ends_.push_back(zone.triangle_count());
    }
    complete_ = pieces.complete();
  }

  std::int64_t layers() const { return static_cast<std::int64_t>(ends_.size()); }
  bool complete() const { return complete_; }

  // The number of triangles below a slice. They come first.
  Index triangles_below(std::int64_t slice) const {
    return slice == 0 ? 0 : ends_[static_cast<std::size_t>(slice) - 1];
  }

  // The slice that a vertex was extracted on, or the one below it.
  std::int64_t slice_of(Index v) const { return zone.options.numbering.place(zone.vertices[v].id).low[2]; }
  bool is_on_slice(Index v) const { return !zone.options.numbering.place(zone.vertices[v].id).along(2); }

  // The number of layers with which a vertex has all its triangles. Without the rest of the surface some never do.
  std::int64_t layers_for(Index v) const {
    const std::int64_t needed = slice_of(v) + 1;
    return complete_ ? std::min(needed, layers()) : needed;
  }

  // Calls see(half-edge) for every edge.
  template <class See>
  void each_edge(const See& see) const {
    for (Index t = 0; t < zone.triangle_count(); ++t) {
      for (Index h = half_edge(t, 0); h <= half_edge(t, 2); ++h) {
        if (zone.alive(h) && zone.represents_edge(h)) see(h);
      }
    }
  }

  Zone zone;

 private:
  std::vector<Index> ends_;  // of the triangles of each layer
  bool complete_ = false;
};

// Decides edges behind a front that moves layer by layer.
class Tandem {
 public:
  Tandem(CompleteSurface& surface, std::int64_t lag, double layer_height)
      : surface_(surface),
        zone_(surface.zone),
        decider_(surface.zone),
        lag_(static_cast<double>(lag)),
        layer_height_(layer_height),
        later_(static_cast<std::size_t>(surface.layers()) + 2),
        undecided_(surface.zone.vertices.size(), 0) {
    surface_.each_edge([&](Index h) { offer(h); });
  }

  void run() {
    for (front_ = 1; front_ <= surface_.layers(); ++front_) {
      take_layer();
      offer_waiting();
      while (heap_.pop_group(group_)) decide_group();
      forget_final();
    }
  }

  std::uint64_t collapses() const { return decider_.counts().collapses; }
  std::uint64_t held() const { return held_.size(); }
  std::uint64_t most_held() const { return most_held_; }

 private:
  bool is_last() const { return surface_.complete() && front_ == surface_.layers(); }

  void take_layer() {
    for (Index t = surface_.triangles_below(front_ - 1); t < surface_.triangles_below(front_); ++t) held_.push_back(t);
    most_held_ = std::max<std::uint64_t>(most_held_, held_.size());
    std::vector<RadixHeap::Entry>& arrived = later_[static_cast<std::size_t>(front_)];
    waiting_.insert(waiting_.end(), arrived.begin(), arrived.end());
    arrived = {};
  }

  void offer_waiting() {
    heap_.clear();
    for (const RadixHeap::Entry entry : std::exchange(waiting_, {})) {
      if (is_current(entry)) offer(entry.edge);
    }
  }

  bool is_current(RadixHeap::Entry entry) const {
    return zone_.alive(entry.edge) && zone_.cost(entry.edge) == entry.cost && zone_.represents_edge(entry.edge);
  }

  // Puts an edge where it has to wait: for its ends, for the front to move on, or for its turn.
  void offer(Index h) {
    const CostBits cost = zone_.cost(h);
    if (cost > zone_.options.retire) return;
    const std::int64_t needed =
        std::max(surface_.layers_for(zone_.origin(h)), surface_.layers_for(zone_.destination(h)));
    if (needed > front_) {
      if (needed <= surface_.layers()) later_[static_cast<std::size_t>(needed)].push_back({cost, h});
    } else if (cost <= limit_of(h)) {
      heap_.push(cost, h);
    } else {
      waiting_.push_back({cost, h});
    }
  }

  CostBits limit_of(Index h) const {
    if (is_last()) return zone_.options.retire;
    const double nearer =
        std::max(zone_.vertices[zone_.origin(h)].position.z, zone_.vertices[zone_.destination(h)].position.z);
    const double distance = static_cast<double>(front_) - nearer / layer_height_;
    if (distance >= lag_) return zone_.options.retire;
    const double part = std::max(distance / lag_, 0.0);
    return cost_bits(static_cast<float>(part * part) * cost_value(zone_.options.retire));
  }

  // Decides edges of equal cost, by tie.
  void decide_group() {
    std::sort(group_.begin(), group_.end(),
              [&](RadixHeap::Entry a, RadixHeap::Entry b) { return zone_.tie(a.edge) < zone_.tie(b.edge); });
    for (const RadixHeap::Entry entry : group_) {
      if (!is_current(entry)) continue;
      decider_.look_at(entry.edge);
      decider_.decide();
      for (int n = 0; n < decider_.changed_count(); ++n) {
        const Index changed = decider_.changed()[static_cast<std::size_t>(n)];
        const Index other = zone_.twin(changed);
        offer(exists(other) ? std::min(changed, other) : changed);
      }
    }
  }

  // Forgets the triangles that a sweep would write now: all their edges at all their vertices are retired.
  void forget_final() {
    const auto mark = [&](Index v) { undecided_[v] = front_; };
    for (const RadixHeap::Entry entry : waiting_) {
      if (!is_current(entry)) continue;
      mark(zone_.origin(entry.edge));
      mark(zone_.destination(entry.edge));
    }
    const auto has = [&](Index t, const auto& is) {
      return std::ranges::any_of(zone_.triangles[t].sides, [&](const HalfEdge& side) { return is(side.vertex); });
    };
    std::erase_if(held_, [&](Index t) { return !zone_.alive(half_edge(t, 0)); });
    for (const Index t : held_) {
      if (!has(t, [&](Index v) { return surface_.layers_for(v) > front_; })) continue;
      for (const HalfEdge& side : zone_.triangles[t].sides) mark(side.vertex);
    }
    std::erase_if(held_, [&](Index t) { return !has(t, [&](Index v) { return undecided_[v] == front_; }); });
  }

  CompleteSurface& surface_;
  Zone& zone_;
  Decider decider_;
  const double lag_, layer_height_;
  std::int64_t front_ = 0;                            // layers that the sweep has taken in
  std::vector<std::vector<RadixHeap::Entry>> later_;  // edges, by the layers that their ends need
  std::vector<RadixHeap::Entry> waiting_;             // edges that are above their limits
  RadixHeap heap_;
  std::vector<RadixHeap::Entry> group_;
  std::vector<Index> held_;              // triangles
  std::vector<std::int64_t> undecided_;  // per vertex: the last front with which it was
  std::uint64_t most_held_ = 0;
};

// Retires the edges that have an end on a slice between two slabs, and returns the most triangles of a slab. No other
// edges of two slabs share a triangle, so one queue decides what a queue for each slab would.
std::uint64_t freeze_fronts(CompleteSurface& surface, std::int64_t thickness) {
  const auto is_frozen = [&](Index v) {
    const std::int64_t slice = surface.slice_of(v);
    const bool is_inner = slice > 0 && !(surface.complete() && slice == surface.layers());
    return surface.is_on_slice(v) && slice % thickness == 0 && is_inner;
  };
  surface.each_edge([&](Index h) {
    if (is_frozen(surface.zone.origin(h)) || is_frozen(surface.zone.destination(h))) {
      surface.zone.set_cost(h, kRetiredCost);
    }
  });
  std::uint64_t most = 0;
  for (std::int64_t first = 0; first < surface.layers(); first += thickness) {
    const std::int64_t end = std::min(first + thickness, surface.layers());
    most = std::max<std::uint64_t>(most, surface.triangles_below(end) - surface.triangles_below(first));
  }
  return most;
}

// Simplifies the complete surface, by a method other than isoweave.
Outcome simplify_complete(const Arguments& arguments, const Task& task, Pieces& pieces, FinalOutput& output,
                          const Executor& executor) {
  Outcome outcome;
  CompleteSurface surface(task.simplify.zone, pieces, executor);
  outcome.extracted = outcome.most_held = surface.zone.triangle_count();
  if (arguments.method == "tandem") {
    Tandem tandem(surface, arguments.layers_of_method, task.volume.geometry.spacing[2]);
    tandem.run();
    outcome.held = tandem.held();
    outcome.most_held = tandem.most_held();
    outcome.collapses = tandem.collapses();
  } else {
    if (arguments.method == "frozen") outcome.most_held = freeze_fronts(surface, arguments.layers_of_method);
    Queue queue(surface.zone);
    queue.run(nullptr);
    outcome.collapses = queue.counts().collapses;
  }
  AllTriangles all(surface.zone, executor);
  output.take(all);
  return outcome;
}

// Simplifies slab by slab, as the library does.
Outcome simplify_slabs(const Arguments& arguments, const Task& task, Pieces& pieces, FinalOutput& output,
                       const Executor& executor) {
  Outcome outcome;
  Simplifier simplifier({task.simplify.zone, Schedule::kLocal}, executor, nullptr);
  while (const SurfacePiece* piece = pieces.next(arguments.layers_of_method)) {
    outcome.extracted += piece->triangles.size();
    simplifier.append(*piece);
    outcome.most_held = std::max(outcome.most_held, simplifier.live_triangles());
    simplifier.decide();
    output.take(simplifier.final_source());
  }
  outcome.held = simplifier.live_triangles();
  outcome.collapses = simplifier.counts().collapses;
  AllTriangles rest(simplifier.zone(), executor);
  output.take(rest);
  return outcome;
}

nlohmann::ordered_json run(const Arguments& arguments) {
  const StandardFloats floats;
  const Executor executor(1);
  const std::unique_ptr<SliceSource> source = open_volume(arguments.volume);
  const Task task = resolve(source->info(), arguments.options, RunControl{});
  const std::unique_ptr<MeshSink> sink = open_mesh_file(arguments.mesh);
  const World world(task.volume.geometry, task.space, sink->offset());
  FinalOutput output(world, *sink, executor);
  Pieces pieces(*source, task, arguments.until, executor);
  const auto simplify = arguments.method == "isoweave" ? simplify_slabs : simplify_complete;
  const Outcome outcome = simplify(arguments, task, pieces, output, executor);
  output.wait();
  sink->finish();
  SurfaceReport report;
  output.report(report);
  return {{"layers", pieces.done()},        {"triangles_extracted", outcome.extracted},
          {"triangles", report.triangles},  {"components", report.components},
          {"euler", report.euler},          {"open_edges", report.open_edges},
          {"collapses", outcome.collapses}, {"held", outcome.held},
          {"most_held", outcome.most_held}, {"digest", digest_text(report.digest)}};
}

Arguments parse(int count, char** words) {
  if (count != 6 && count != 7) throw std::invalid_argument("expected VOLUME ISO ERROR METHOD MESH.ply [LAYERS]");
  Arguments arguments;
  arguments.volume = words[1];
  arguments.options.iso = std::stod(words[2]);
  arguments.options.error = Length::voxels(std::stod(words[3]));
  arguments.options.closed = false;
  const std::string method = words[4];
  const std::size_t colon = method.find(':');
  arguments.method = method.substr(0, colon);
  if (colon != std::string::npos) arguments.layers_of_method = std::stoll(method.substr(colon + 1));
  const bool in_slabs = arguments.method == "isoweave" || arguments.method == "frozen";
  const bool known = in_slabs || arguments.method == "tandem" || method == "queue";
  if (!known || arguments.layers_of_method < (in_slabs ? 1 : 0)) {
    throw std::invalid_argument("expected queue, isoweave:T, tandem:L or frozen:T, found " + method);
  }
  arguments.mesh = words[5];
  if (count == 7) arguments.until = std::stoll(words[6]);
  return arguments;
}

}  // namespace

int main(int count, char** words) try {
  std::puts(run(parse(count, words)).dump(2).c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_baselines: %s\n", error.what());
  return 2;
}
