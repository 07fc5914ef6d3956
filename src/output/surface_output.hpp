// Triangles on their way to the sink: their vertices are numbered, they are measured and handed over.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "measure/component_counter.hpp"
#include "output/overlapped_sink.hpp"
#include "output/world.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

// A vertex that has been written.
struct OutputCorner {
  std::uint64_t number;  // in the output
  std::uint32_t label;   // of its component
  Point point;           // where it lies in the output
};

// A piece on its way out. Its triangles name vertices that have been written first, then the new ones.
struct OutputPiece {
  std::span<const Vec3> positions;  // of new vertices
  std::span<const Point> normals;   // of new vertices; or none
  std::span<const float> values;    // of new vertices; or none
  std::span<const std::array<std::uint32_t, 3>> triangles;
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

  // Writes a piece. `written`: the vertices written before that it names; the first new vertex is appended, from whose
  // number and label on the new ones have theirs. Returns that vertex.
  OutputCorner take(const OutputPiece& piece, std::vector<OutputCorner>& written);

  // The place of a position in the output.
  Point point(Vec3 position) const { return world_.point(position); }

  ComponentCounter& components() { return components_; }

  // The number and label of the next vertex that is added.
  std::uint64_t next_number() const { return vertices_; }
  std::uint32_t next_label() const { return static_cast<std::uint32_t>(components_.labels()); }

  bool measures() const { return measure_; }

  // The places of the vertices added last, until others are added.
  std::span<const Point> added_points() const { return room_.vertices; }

  // Returns when the sink has received everything. Throws what it threw.
  void wait() { overlapped_.wait(); }

  // Fills in the counts, Euler number, components and digest of what has been written.
  void report(std::uint64_t open_edges, SurfaceReport& report) const;

  // The counts between two pieces: written, and read before the first one. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state);

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

  std::uint32_t add_vertices(const OutputPiece& piece);
  template <class Index>
  void add_triangles(std::span<const std::array<std::uint32_t, 3>> from, std::span<const OutputCorner> written,
                     std::span<std::array<Index, 3>> out);
  void measure(std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const OutputCorner> written);
  void show(std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const OutputCorner> written) const;
  OutputCorner corner(std::uint32_t v, std::span<const OutputCorner> written) const;

  // The order in which the corners of a triangle are written.
  std::array<std::size_t, 3> turn() const {
    return world_.mirrors() ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2};
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
