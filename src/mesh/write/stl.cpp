// STL, binary. Each triangle repeats its corners, and may refer to any vertex appended so far: the positions of all
// vertices stay in memory, 12 bytes each, and in a file beside the part where the mesh may be continued later. (The
// other formats keep none.)
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kCountAt = 80;
constexpr std::size_t kFacetBytes = 50;
constexpr std::uint64_t kReadBack = 1 << 20;  // positions at a time

// A header that begins with "solid" would announce the ascii dialect.
std::vector<std::byte> header_bytes(const MeshFileOptions& options, std::uint32_t triangles) {
  std::string text = "binary STL, written by isoweave";
  if (!options.space.empty()) text += " SPACE=" + one_line(options.space);
  if (!options.unit.empty()) text += " UNIT=" + one_line(options.unit);
  text.resize(kCountAt);
  std::vector<std::byte> header(kHeaderBytes);
  std::transform(text.begin(), text.end(), header.begin(), [](char c) { return static_cast<std::byte>(c); });
  std::byte* count = header.data() + kCountAt;
  store_u32(count, triangles);
  return header;
}

// The unit normal of a facet, by the right-hand rule; zero for a triangle without area, as is the custom.
Point facet_normal(const Point& a, const Point& b, const Point& c) {
  std::array<double, 3> u{};
  std::array<double, 3> v{};
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = double{b[i]} - double{a[i]};
    v[i] = double{c[i]} - double{a[i]};
  }
  const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  // Overflow of huge coordinates leaves no direction either.
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

// Positions by number. They never move, as a growing array would need twice its memory for a moment.
class Positions {
 public:
  std::uint64_t size() const { return size_; }

  const Point& operator[](std::uint64_t n) const { return blocks_[n / kBlock][n % kBlock]; }

  void append(std::span<const Point> points) {
    while (!points.empty()) {
      if (size_ % kBlock == 0) blocks_.push_back(std::make_unique<Point[]>(kBlock));
      const std::uint64_t from = size_ % kBlock;
      const std::size_t count = std::min<std::size_t>(points.size(), kBlock - from);
      std::ranges::copy(points.first(count), blocks_.back().get() + from);
      points = points.subspan(count);
      size_ += count;
    }
  }

 private:
  static constexpr std::uint64_t kBlock = 1 << 16;

  std::vector<std::unique_ptr<Point[]>> blocks_;
  std::uint64_t size_ = 0;
};

class StlSink final : public MeshFileSink {
 public:
  StlSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, without_normals(options)), places_(path(), options) {
    if (!options.parts.empty()) kept_positions_ = &open_side("positions.part");
    continued() ? read_positions_back() : file().write(header_bytes(options, 0));
    if (continued() && has_offset()) places_.load(saved_state(1));
  }

  std::vector<std::string> notes() const override { return places_.notes(); }

 private:
  std::vector<std::uint64_t> state() const override {
    return has_offset() ? places_.state() : std::vector<std::uint64_t>{};
  }

  void write_piece(const MeshPiece& piece) override {
    check_count_fits(path(), "triangles", this->triangles(), piece.triangles.size());
    positions_.append(piece.vertices);
    if (kept_positions_ != nullptr) kept_positions_->write(std::as_bytes(piece.vertices));
    write_records(file(), records_, piece.triangles.size(), kFacetBytes,
                  [&](std::byte*& out, std::size_t n) { store_triangle(out, piece.triangles[n]); });
  }

  void store_triangle(std::byte*& out, const Triangle64& triangle) {
    const Point& a = positions_[triangle[0]];
    const Point& b = positions_[triangle[1]];
    const Point& c = positions_[triangle[2]];
    store_point(out, facet_normal(a, b, c));
    for (const Point& point : {a, b, c}) store_point(out, has_offset() ? places_.point(point) : point);
    *out++ = std::byte{0};  // the attribute count, unused
    *out++ = std::byte{0};
  }

  void complete() override {
    const std::vector<std::byte> header = header_bytes(options(), static_cast<std::uint32_t>(triangles()));
    file().overwrite(0, header);
    check_written(kHeaderBytes + triangles() * kFacetBytes, header);
  }

  void read_positions_back() {
    std::vector<Point> some;
    while (positions_.size() < vertices()) {
      some.resize(std::min<std::uint64_t>(kReadBack, vertices() - positions_.size()));
      kept_positions_->read_back(positions_.size() * sizeof(Point), std::as_writable_bytes(std::span(some)));
      positions_.append(some);
    }
  }

  RoundedPlaces places_;
  Positions positions_;
  OutputDescriptor* kept_positions_ = nullptr;
  std::vector<std::byte> records_;
};

}  // namespace

std::unique_ptr<MeshSink> open_stl(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<StlSink>(target, options);
}

}  // namespace isoweave
