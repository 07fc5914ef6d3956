// Triangles on their way to the sink: their vertices are numbered, they are measured and handed over.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>

#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "measure/component_counter.hpp"
#include "output/overlapped_sink.hpp"
#include "output/sweep_view.hpp"
#include "output/world.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

// A vertex of a triangle on its way out.
struct OutputCorner {
  std::uint64_t number;  // in the output
  std::uint32_t label;   // of its component
  Point point;           // where it lies in the output
};

class SurfaceOutput {
 public:
  // measure: find digest and components. A sink that has room gets each piece as it is made. With several threads, a
  // sink without room gets a piece while the next one is made. observer: sees all triangles, unless it is null.
  SurfaceOutput(const World& world, MeshSink& sink, const Executor& executor, bool measure,
                SweepObserver* observer = nullptr)
      : world_(world),
        executor_(executor),
        measure_(measure),
        observer_(observer),
        sink_(sink),
        overlapped_(sink, executor.threads() > 1) {}

  std::uint64_t vertices() const { return vertices_; }

  // The place of a position in the output.
  Point point(Vec3 position) const { return world_.point(position); }

  ComponentCounter& components() { return components_; }

  // The label of the next vertex that is added.
  std::uint32_t next_label() const { return static_cast<std::uint32_t>(components_.labels()); }

  // Begins a piece with its vertices, which get consecutive numbers from vertices() on and consecutive labels from the
  // returned one. position(n), normal(n) and value(n) give the attributes of the n-th vertex, and are called by any
  // thread; the latter two only where there are any.
  template <class Position, class Normal, class Value>
  std::uint32_t add_vertices(const MeshPieceSize& size, const Position& position, const Normal& normal,
                             const Value& value) {
    make_room(size);
    executor_.for_each(static_cast<std::int64_t>(size.vertices), kBlock, [&](std::int64_t i) {
      const auto n = static_cast<std::size_t>(i);
      room_.vertices[n] = world_.point(position(n));
      if (size.normals) room_.normals[n] = world_.normal(normal(n));
      if (size.values) room_.values[n] = value(n);
    });
    vertices_ += size.vertices;
    return measure_ ? components_.add(size.vertices) : 0;
  }

  bool measures() const { return measure_; }

  // The places of the vertices added last, until others are added.
  std::span<const Point> added_points() const { return room_.vertices; }

  // Completes the piece with its triangles, as many as it was begun for, and hands it to the sink. number(first, out)
  // writes the corners of consecutive triangles by their numbers in the output, in 32 or 64 bits. corner(n, c) gives
  // corner c of the n-th triangle. Called by any thread.
  template <class Number, class CornerOf>
  void add_triangles(const Number& number, const CornerOf& corner) {
    if (sink_.has_room()) return write_triangles(room_.triangles, number, corner);
    auto& triangles = buffer().triangles;
    write_triangles(std::span(triangles.begin(), triangles.end()), number, corner);
    hand_over();
  }

  // Returns when the sink has received everything. Throws what it threw.
  void wait() { overlapped_.wait(); }

  // Fills in the counts, Euler number, components and digest of what has been written.
  void report(std::uint64_t open_edges, SurfaceReport& report) const;

  template <class Archive>
  void exchange(Archive& archive) {
    std::uint64_t digest = digest_;
    archive.value(vertices_);
    archive.value(triangles_);
    archive.value(digest);
    components_.exchange(archive);
    digest_ = digest;
  }

 private:
  static constexpr std::int64_t kBlock = 4096;

  // A piece on its way to a sink that has no room for it.
  struct Buffer {
    Array<Point> vertices;
    Array<Point> normals;
    Array<float> values;
    Array<std::array<std::uint64_t, 3>> triangles;
  };

  Buffer& buffer() { return buffers_[next_]; }
  void make_room(const MeshPieceSize& size);
  void hand_over();

  // Numbers, measures and shows triangles.
  template <class Index, class Number, class CornerOf>
  void write_triangles(std::span<std::array<Index, 3>> triangles, const Number& number, const CornerOf& corner) {
    const std::array<std::size_t, 3> turn =
        world_.mirrors() ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2};
    executor_.for_blocks(static_cast<std::int64_t>(triangles.size()), kBlock, [&](std::int64_t from, std::int64_t to) {
      const auto begin = static_cast<std::size_t>(from);
      const auto end = static_cast<std::size_t>(to);
      const std::span block = triangles.subspan(begin, end - begin);
      number(begin, block);
      if (world_.mirrors()) {
        for (auto& triangle : block) std::swap(triangle[1], triangle[2]);
      }
      if (!measure_) return;
      std::uint64_t digest = 0;
      std::uint64_t joins = 0;
      for (std::size_t n = begin; n < end; ++n) {
        const std::array<OutputCorner, 3> corners{corner(n, turn[0]), corner(n, turn[1]), corner(n, turn[2])};
        digest += triangle_digest(corners[0].point, corners[1].point, corners[2].point, world_.offset());
        for (std::size_t c = 1; c < 3; ++c) joins += components_.join(corners[0].label, corners[c].label) ? 1U : 0U;
      }
      digest_.fetch_add(digest, std::memory_order_relaxed);
      components_.count_joins(joins);
    });
    triangles_ += triangles.size();
    if (observer_ == nullptr) return;
    view_triangles(
        triangles.size(), [&](std::size_t n, std::size_t c) { return corner(n, turn.at(c)).point; }, executor_,
        [&](std::span<const TriangleCorners> block) { observer_->add_final(block); });
  }

  const World& world_;
  const Executor& executor_;
  bool measure_;
  SweepObserver* observer_;
  ComponentCounter components_;
  MeshSink& sink_;
  MeshRoom room_;                  // for the piece that is made; in a buffer without its triangles
  std::array<Buffer, 2> buffers_;  // one is filled, the other one is with the sink
  std::size_t next_ = 0;
  std::uint64_t vertices_ = 0;
  std::uint64_t triangles_ = 0;
  std::atomic<std::uint64_t> digest_{0};
  OverlappedSink overlapped_;  // ends before what it reads
};

}  // namespace isoweave
