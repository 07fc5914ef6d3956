// The engine of any device.
//
// The passes are those of the headers beside this one, and a Device runs them (simulated_device.hpp). The surface, the
// decisions and the order of the output are those of the host's MarchingCubes, Zone and HandOver.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "device/append_passes.hpp"
#include "device/bulk_hand_over.hpp"
#include "device/compact_passes.hpp"
#include "device/device_arrays.hpp"
#include "device/device_engine.hpp"
#include "device/extract_passes.hpp"
#include "extract/front_bits.hpp"
#include "isoweave/error.hpp"
#include "parallel/size.hpp"
#include "volume/samples.hpp"

namespace isoweave {

template <class Device>
class BulkEngine final : public DeviceEngine {
 public:
  // Throws OverMemory, before it takes memory, where one layer is too many for a slab.
  BulkEngine(Device device, const BulkOptions& options)
      : device_(std::move(device)), options_(options), most_layers_(most_layers_of(options.volume)) {
    const std::array<std::int64_t, 3>& dims = options.volume.dims;
    bits_.numbering = VertexNumbering::of_cube_edges(dims);
    bits_.closed = options.rule.closed;
    bits_.rows = dims[1] + 2;
    bits_.words = (dims[0] + 2 + 63) / 64;
    end_layer_ = options.rule.closed ? dims[2] : dims[2] - 1;
    cases_.resize(kCaseTable.size());
    device_.write(kCaseTable.data(), kCaseTable.size(), cases_.data());
    choices_.resize(1);
    device_.write(&kChoicePolygons, 1, choices_.data());
    inside_.resize(plane_words());
    front_base_.resize(plane_words() + 1);
    device_.clear(inside_);
    device_.clear(front_base_);
    list_sizes_.resize(kLists);
    device_.clear(list_sizes_);
  }

  VertexNumbering numbering() const override { return bits_.numbering; }
  std::int64_t layers_left() const override { return end_layer_ - next_layer_; }

  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override {
    const std::int64_t margin = options_.normals ? 1 : 0;
    return {next_layer_ - margin, next_layer_ + layers + 1 + margin};
  }

  std::int64_t most_layers() const override { return most_layers_; }

  void upload(const SliceWindow& window, std::int64_t layers) override {
    auto [first, end] = slices_for(layers);
    first = std::max<std::int64_t>(first, 0);
    end = std::min(end, options_.volume.dims[2]);
    const std::size_t bytes = options_.volume.slice_bytes();
    if (end - first > room_) {
      room_ = end - first;
      device_.await_uploads();  // to where the ring has been
      ring_.resize(to_size(room_, bytes));
      uploaded_ = first;
      device_.order_uploads();
    }
    for (std::int64_t k = std::max(first, uploaded_); k < end; ++k) {
      device_.upload(window.slice(k), bytes, ring_.data() + static_cast<std::size_t>(k % room_) * bytes);
    }
    uploaded_ = std::max(uploaded_, end);
  }

  SlabCounts extract(std::int64_t layers, std::uint64_t most_vertices) override {
    device_.await_uploads();
    prepare_words(layers);
    bits_.first_layer = next_layer_;
    const ExtractPasses passes = extract_passes();
    const std::int64_t items = layers * plane();
    auto* const inside = reinterpret_cast<std::uint32_t*>(inside_.data() + plane_words());
    visit_ring([&]<class T>(const SliceRing<T>& ring) {
      device_.template fill_bits<&ExtractPasses::is_inside<T>>(2 * items, passes, inside, ring);
    });
    device_.template for_each<&ExtractPasses::count>(items, passes);
    device_.scan(vertex_base_, static_cast<std::size_t>(items));
    device_.scan(triangle_base_, static_cast<std::size_t>(items));
    SlabCounts counts = choose_layers(layers, most_vertices);
    make_room(counts);
    emit(counts);
    next_layer_ += counts.layers;
    return counts_ = counts;
  }

  void append() override {
    const auto first_vertex = static_cast<Index>(zone_.vertices.size() - counts_.vertices);
    const auto first_triangle = static_cast<Index>(zone_.triangles.size() - counts_.triangles);
    marks_.resize(zone_.vertices.size());
    device_.clear(marks_);
    AppendPasses passes = append_passes(first_vertex, first_triangle);
    link(passes);
    list_settled(passes);
    list_front();
    passes.front = front_.data();
    device_.template for_each<&AppendPasses::mark_front>(front_count(), passes);
    const std::uint32_t settled = list_size(kChanged);
    device_.template for_each<&AppendPasses::settle_vertex>(settled, passes);
    unkeyed_next_.resize(unkeyed_count_ + 3 * counts_.triangles);
    passes.still_unkeyed = list(kUnkeyed, unkeyed_next_);
    device_.template for_each<&AppendPasses::settle_edge>(side_count(), passes, unkeyed_count_);
    device_.template for_each<&AppendPasses::settle_turn>(settled, passes);
    std::swap(unkeyed_, unkeyed_next_);
    unkeyed_count_ = list_size(kUnkeyed);
    appended_ += counts_.triangles;
  }

  void decide() override {
    candidates_.resize(zone_.vertices.size());
    minima_.resize(zone_.vertices.size());
    marks_.resize(zone_.vertices.size());
    device_.clear(marks_);
    rounds_ += device_.run_rounds(
        {zone_, marks_.data(), list(kChanged, changed_), list(kCandidates, candidates_), list(kMinima, minima_)},
        decisions_);
  }

  void take_final(const Receipt& first, FinalPiece& piece) override {
    dropped_ += hand_over_.take(device_, zone_, first, piece);
    const std::uint64_t gone = zone_.triangles.size() - live_triangles();
    if (8 * gone >= zone_.triangles.size()) compact();
  }

  void change_labels(const std::function<void(std::span<std::uint32_t*>)>& change) override {
    std::vector<Vertex> held(zone_.vertices.size());
    device_.read(zone_.vertices.data(), held.size(), held.data());
    std::vector<std::uint32_t*> labels;
    for (Vertex& vertex : held) {
      if (vertex.number != kNotHandedOver) labels.push_back(&vertex.label);
    }
    change(labels);
    device_.write(held.data(), held.size(), zone_.vertices.data());
  }

  std::uint64_t inherited() const override { return inherited_; }
  std::uint64_t front_size() const override { return front_.size(); }

  void write_extraction(StateWriter& state) override {
    FrontBits front{next_layer_, std::vector<std::uint64_t>(plane_words())};
    device_.read(inside_.data(), plane_words(), front.inside.data());
    front.write(state);
  }

  void read_extraction(StateReader& state) override {
    const FrontBits front = FrontBits::read(state, options_.volume.dims, end_layer_);
    next_layer_ = bits_.first_layer = front.next_layer;
    device_.write(front.inside.data(), plane_words(), inside_.data());
    device_.template for_each<&ExtractPasses::count_front>(plane(), extract_passes(), std::int64_t{0},
                                                           front_base_.data());
    device_.scan(front_base_, plane_words());
    inherited_ = layers_left() > 0 ? read_one(front_base_.data() + plane_words()) : 0;
  }

  void write_zone(StateWriter& state) override {
    SimplifierCounts{decisions_, rounds_, appended_, dropped_}.serialize(state);
    state.value(hand_over_.defects);
    ZonePart held;
    read_all(device_, arrays_.vertices, held.vertices);
    read_all(device_, arrays_.states, held.states);
    read_all(device_, arrays_.normals, held.normals);
    read_all(device_, arrays_.triangles, held.triangles);
    read_all(device_, front_, held.front);
    write_part(state, held.view(), {}, held.front);
    state.value(options_.zone.retire);
  }

  void read_zone(StateReader& state, const PartShape& shape) override {
    SimplifierCounts saved;
    saved.serialize(state);
    state.value(hand_over_.defects);
    ZonePart part = read_part(state, shape);
    CostBits limit = 0;
    state.value(limit);
    state.require(limit == options_.zone.retire, "the limit of costs of a run on a device");
    state.require(saved.held() == part.triangles.size(), "as many triangles as are counted");
    decisions_ = saved.decisions;
    rounds_ = saved.rounds;
    appended_ = saved.appended;
    dropped_ = saved.dropped;
    hold(part);
  }

  std::uint64_t live_triangles() const override { return appended_ - decisions_.removed - dropped_; }
  std::size_t held_vertices() const override { return zone_.vertices.size(); }
  std::uint64_t bytes() const override {
    return arrays_.bytes() + spare_.bytes() + hand_over_.bytes() +
           sum_bytes(ring_, inside_, vertex_base_, triangle_base_, front_base_, front_next_base_, front_, front_next_,
                     unkeyed_, unkeyed_next_, marks_, side_base_, side_fill_, sides_, changed_, candidates_, minima_,
                     triangle_place_, vertex_place_);
  }
  std::uint64_t room_for_vertices(std::uint64_t cap) const override {
    // The bytes of a vertex with its triangles: twice in the zone, as compaction moves them from one set of arrays to
    // another, and in the lists of the passes.
    constexpr std::uint64_t kZone = sizeof(Vertex) + sizeof(Key) + sizeof(Turn) + 2 * sizeof(Triangle) + sizeof(Point);
    constexpr std::uint64_t kPasses = 16 * sizeof(Index) + 6 * sizeof(EdgeSide) + sizeof(KnownVertex) + sizeof(Point);
    const std::uint64_t held = bytes();
    std::uint64_t room = device_.free_bytes();
    if (cap > 0) room = std::min(room, cap > held ? cap - held : 0);
    return room / (2 * kZone + kPasses);
  }
  std::uint64_t rounds() const override { return rounds_; }
  const DecisionCounts& decisions() const override { return decisions_; }
  const SurfaceDefects& defects() const override { return hand_over_.defects; }

 private:
  template <class T>
  using Buffer = typename Device::template Buffer<T>;

  enum List : std::size_t { kChanged, kCandidates, kMinima, kUnkeyed, kLists };

  // A point of the lattice has at most three vertices and five triangles to count, so sums over 2^29 points stay below
  // 2^32.
  static std::int64_t most_layers_of(const VolumeInfo& volume) {
    constexpr std::int64_t kMostSamples = std::int64_t{1} << 29;
    const std::int64_t samples = (volume.dims[0] + 2) * (volume.dims[1] + 2);
    if (samples > kMostSamples) {
      throw OverMemory(volume.path + ": a slice has " + std::to_string(samples) +
                       " samples, expected at most 2^29 on a device: use the processor");
    }
    return kMostSamples / samples;
  }

  std::size_t plane_words() const { return to_size(bits_.plane()); }
  std::int64_t plane() const { return bits_.plane(); }
  std::int64_t front_count() const { return signed_count(front_.size()); }
  std::int64_t side_count() const { return unkeyed_count_ + 3 * signed_count(counts_.triangles); }

  std::uint32_t read_one(const std::uint32_t* from) { return isoweave::read_one(device_, from); }

  // A list of a pass: its items, and where its size is kept. A pass adds to the list, unless the size is set to 0
  // first.
  IndexList list(List which, Buffer<Index>& items) { return {items.data(), list_sizes_.data() + which}; }
  std::uint32_t list_size(List which) { return read_one(list_sizes_.data() + which); }
  void set_list_size(List which, std::uint32_t size) { device_.write(&size, 1, list_sizes_.data() + which); }

  template <class Visit>
  void visit_ring(const Visit& visit) {
    visit_sample_type(options_.volume.type, [&]<class T>() {
      visit(SliceRing<T>{reinterpret_cast<const T*>(ring_.data()), options_.volume.dims,
                         std::max<std::int64_t>(room_, 1)});
    });
  }

  void prepare_words(std::int64_t layers) {
    const auto count = static_cast<std::size_t>(layers);
    inside_.resize((count + 1) * plane_words());
    vertex_base_.resize(count * plane_words() + 1);
    triangle_base_.resize(count * plane_words() + 1);
  }

  ExtractPasses extract_passes() {
    bits_.inside = inside_.data();
    ExtractPasses passes;
    passes.bits = bits_;
    passes.rule = options_.rule;
    passes.spacing = options_.volume.geometry.spacing;
    passes.cases = cases_.data();
    passes.choices = choices_.data();
    passes.vertex_base = vertex_base_.data();
    passes.triangle_base = triangle_base_.data();
    passes.front_base = front_base_.data();
    passes.front = front_.data();
    passes.inherited = static_cast<std::uint32_t>(front_.size());
    passes.first_vertex = static_cast<Index>(zone_.vertices.size());
    passes.first_triangle = static_cast<Index>(zone_.triangles.size());
    return passes;
  }

  // Chooses as many layers as hold no more than so many vertices, one at least.
  SlabCounts choose_layers(std::int64_t layers, std::uint64_t most_vertices) {
    SlabCounts counts;
    do {
      const std::size_t end = static_cast<std::size_t>(counts.layers + 1) * plane_words();
      const std::uint32_t vertices = read_one(vertex_base_.data() + end);
      if (counts.layers > 0 && vertices > most_vertices) break;
      counts.vertices = vertices;
      counts.triangles = read_one(triangle_base_.data() + end);
      ++counts.layers;
    } while (counts.layers < layers);
    return counts;
  }

  // Takes a part into the memory of the device.
  void hold(const ZonePart& part) {
    const std::size_t vertices = part.vertices.size();
    write_all(device_, part.vertices, arrays_.vertices);
    write_all(device_, part.states, arrays_.states);
    write_all(device_, part.normals, arrays_.normals);
    write_all(device_, std::vector<Key>(vertices, kNoTurn), arrays_.turn_keys);
    write_all(device_, std::vector<Turn>(vertices), arrays_.turns);
    write_all(device_, part.triangles, arrays_.triangles);
    zone_ = arrays_.view(options_.zone);
    write_all(device_, part.front, front_);
    write_all(device_, part.unkeyed_edges, unkeyed_);
    unkeyed_count_ = static_cast<std::uint32_t>(part.unkeyed_edges.size());
    turns_known_ = false;
  }

  void make_room(const SlabCounts& counts) {
    const std::uint64_t triangles = zone_.triangles.size() + counts.triangles;
    const std::uint64_t vertices = zone_.vertices.size() + counts.vertices;
    if (triangles >= kWritten / 4 || vertices >= EdgeSide::kBackwards) {
      throw OverMemory("the undecided zone would hold " + std::to_string(triangles) +
                       " triangles, expected fewer than 2^30: choose thinner slabs or a smaller error");
    }
    arrays_.resize(vertices, triangles, options_.normals);
  }

  void emit(SlabCounts& counts) {
    ExtractPasses passes = extract_passes();
    zone_ = arrays_.view(options_.zone);
    passes.zone = zone_;
    const std::int64_t items = counts.layers * plane();
    SlabTotals totals;
    visit_ring([&]<class T>(const SliceRing<T>& ring) {
      device_.template for_each<&ExtractPasses::emit_vertices<T>>(items, passes, ring);
    });
    totals += device_.template sum<&ExtractPasses::emit_triangles, SlabTotals>(items, passes);
    counts.cells_crossed = totals.cells;
  }

  AppendPasses append_passes(Index first_vertex, Index first_triangle) {
    changed_.resize(zone_.vertices.size());
    set_list_size(kChanged, 0);
    set_list_size(kUnkeyed, 0);
    AppendPasses passes;
    passes.zone = zone_;
    passes.first_vertex = first_vertex;
    passes.first_triangle = first_triangle;
    passes.marks = marks_.data();
    passes.unkeyed = {unkeyed_.data(), nullptr};
    passes.settled = list(kChanged, changed_);
    return passes;
  }

  void link(AppendPasses& passes) {
    const std::size_t vertices = zone_.vertices.size();
    side_base_.resize(vertices + 1);
    side_fill_.resize(vertices + 1);
    sides_.resize(static_cast<std::size_t>(side_count()));
    device_.clear(side_base_);
    passes.side_base = side_base_.data();
    passes.side_fill = side_fill_.data();
    passes.sides = sides_.data();
    device_.template for_each<&AppendPasses::count_side>(side_count(), passes, unkeyed_count_);
    device_.scan(side_base_, vertices);
    device_.copy(side_base_.data(), vertices, side_fill_.data());
    device_.template for_each<&AppendPasses::fill_side>(side_count(), passes, unkeyed_count_);
    device_.template for_each<&AppendPasses::pair_sides>(signed_count(vertices), passes);
  }

  void list_settled(const AppendPasses& passes) {
    device_.template for_each<&AppendPasses::settle_front>(front_count(), passes,
                                                           static_cast<const Index*>(front_.data()));
    device_.template for_each<&AppendPasses::settle_ends>(unkeyed_count_, passes);
    if (!turns_known_) device_.template for_each<&AppendPasses::settle_held>(passes.first_vertex, passes);
    turns_known_ = true;
    device_.template for_each<&AppendPasses::settle_new>(signed_count(counts_.vertices), passes);
  }

  // Makes the front of the next slab: the crossings and the bits of this slab's last slice.
  void list_front() {
    front_next_base_.resize(plane_words() + 1);
    ExtractPasses passes = extract_passes();
    passes.first_vertex = static_cast<Index>(zone_.vertices.size() - counts_.vertices);
    device_.template for_each<&ExtractPasses::count_front>(plane(), passes, counts_.layers, front_next_base_.data());
    device_.scan(front_next_base_, plane_words());
    const bool last = layers_left() == 0;
    front_next_.resize(last ? 0 : read_one(front_next_base_.data() + plane_words()));
    if (!last) {
      device_.template for_each<&ExtractPasses::list_front>(plane(), passes, counts_.layers,
                                                            static_cast<const std::uint32_t*>(front_next_base_.data()),
                                                            front_next_.data());
    }
    std::swap(front_, front_next_);
    inherited_ = front_.size();
    std::swap(front_base_, front_next_base_);
    device_.copy(inside_.data() + static_cast<std::size_t>(counts_.layers) * plane_words(), plane_words(),
                 inside_.data());
  }

  void compact() {
    const std::size_t vertices = zone_.vertices.size();
    const std::size_t triangles = zone_.triangles.size();
    vertex_place_.resize(vertices + 1);
    triangle_place_.resize(triangles + 1);
    device_.clear(vertex_place_);
    CompactPasses passes;
    passes.from = zone_;
    passes.triangle_place = triangle_place_.data();
    passes.vertex_place = vertex_place_.data();
    passes.front = front_.data();
    passes.unkeyed = unkeyed_.data();
    device_.template for_each<&CompactPasses::keep_front>(front_count(), passes);
    device_.template for_each<&CompactPasses::keep_triangle>(signed_count(triangles), passes);
    device_.scan(triangle_place_, triangles);
    device_.scan(vertex_place_, vertices);
    spare_.resize(read_one(vertex_place_.data() + vertices), read_one(triangle_place_.data() + triangles),
                  options_.normals);
    passes.to = spare_.view(options_.zone);
    device_.template for_each<&CompactPasses::move_triangle>(signed_count(triangles), passes);
    device_.template for_each<&CompactPasses::move_vertex>(signed_count(vertices), passes);
    device_.template for_each<&CompactPasses::move_front>(front_count(), passes);
    device_.template for_each<&CompactPasses::move_unkeyed>(unkeyed_count_, passes);
    std::swap(arrays_, spare_);
    zone_ = passes.to;
  }

  Device device_;
  BulkOptions options_;
  std::int64_t most_layers_;
  SlabBits bits_;
  std::int64_t next_layer_ = -1;
  std::int64_t end_layer_ = 0;

  // Samples and bits of the slab.
  Buffer<std::byte> ring_;
  std::int64_t room_ = 0;      // slices
  std::int64_t uploaded_ = 0;  // slices below are, or were, on the device
  Buffer<CellCase> cases_;
  Buffer<ChoicePolygons> choices_;
  Buffer<std::uint64_t> inside_;
  Buffer<std::uint32_t> vertex_base_, triangle_base_, front_base_, front_next_base_;
  SlabCounts counts_;

  // The zone.
  DeviceZone<Device> arrays_, spare_;  // compaction moves elements from one to the other
  ZoneView zone_;
  Buffer<Index> front_, front_next_;
  Buffer<Index> unkeyed_, unkeyed_next_;
  std::uint32_t unkeyed_count_ = 0;
  std::uint64_t inherited_ = 0;
  bool turns_known_ = true;
  Buffer<std::uint32_t> marks_, side_base_, side_fill_;
  Buffer<EdgeSide> sides_;
  Buffer<Index> changed_, candidates_, minima_;
  Buffer<std::uint32_t> list_sizes_;

  Buffer<std::uint32_t> triangle_place_, vertex_place_;  // of a compaction
  BulkHandOver<Device> hand_over_;

  std::uint64_t appended_ = 0, dropped_ = 0, rounds_ = 0;
  DecisionCounts decisions_;
};

}  // namespace isoweave
