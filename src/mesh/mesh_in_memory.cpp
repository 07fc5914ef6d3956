#include <algorithm>
#include <limits>
#include <stdexcept>

#include "isoweave/mesh.hpp"
#include "parallel/array.hpp"

namespace isoweave {
namespace {

template <class T>
std::span<const T> all(const Array<T>& array) {
  return {array.data(), array.size()};
}

template <class T>
std::vector<T> list(const Array<T>& array) {
  return {array.begin(), array.end()};
}

// Makes an array longer, and returns the new part. Reserved room that is not used takes addresses but no memory. The
// first reservation spares the copies with which small arrays grow.
template <class T>
std::span<T> add(Array<T>& array, std::size_t count) {
  constexpr std::size_t kFirst = (std::size_t{16} << 20) / sizeof(T);
  const std::size_t before = array.size();
  const std::size_t after = before + count;
  if (after > array.capacity()) array.reserve(std::max({kFirst, 2 * array.capacity(), after}));
  array.resize(after);
  return {array.data() + before, count};
}

}  // namespace

struct MeshInMemory::Arrays {
  Array<Point> vertices, normals;
  Array<float> values;
  Array<std::array<std::uint32_t, 3>> triangles;
};

MeshInMemory::MeshInMemory(const std::array<double, 3>& offset)
    : arrays_(std::make_unique<Arrays>()), offset_(offset) {}
MeshInMemory::~MeshInMemory() = default;
MeshInMemory::MeshInMemory(MeshInMemory&&) noexcept = default;
MeshInMemory& MeshInMemory::operator=(MeshInMemory&&) noexcept = default;

void MeshInMemory::append(const MeshPiece& piece) {
  const MeshRoom fresh =
      room({piece.vertices.size(), piece.triangles.size(), !piece.normals.empty(), !piece.values.empty()});
  std::copy(piece.vertices.begin(), piece.vertices.end(), fresh.vertices.begin());
  std::copy(piece.normals.begin(), piece.normals.end(), fresh.normals.begin());
  std::copy(piece.values.begin(), piece.values.end(), fresh.values.begin());
  std::transform(piece.triangles.begin(), piece.triangles.end(), fresh.triangles.begin(), [](const auto& triangle) {
    return std::array{static_cast<std::uint32_t>(triangle[0]), static_cast<std::uint32_t>(triangle[1]),
                      static_cast<std::uint32_t>(triangle[2])};
  });
}

MeshRoom MeshInMemory::room(const MeshPieceSize& size) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (size.vertices > kMost - arrays_->vertices.size()) {
    throw std::length_error("a mesh in memory has at most 2^32 - 1 vertices, this one more");
  }
  return {add(arrays_->vertices, size.vertices), add(arrays_->normals, size.normals ? size.vertices : 0),
          add(arrays_->values, size.values ? size.vertices : 0), add(arrays_->triangles, size.triangles)};
}

std::span<const Point> MeshInMemory::vertices() const { return all(arrays_->vertices); }
std::span<const Point> MeshInMemory::normals() const { return all(arrays_->normals); }
std::span<const float> MeshInMemory::values() const { return all(arrays_->values); }
std::span<const std::array<std::uint32_t, 3>> MeshInMemory::triangles() const { return all(arrays_->triangles); }

TriangleMesh MeshInMemory::copy() const {
  return {list(arrays_->vertices), list(arrays_->triangles), list(arrays_->normals), list(arrays_->values), offset_};
}

}  // namespace isoweave
