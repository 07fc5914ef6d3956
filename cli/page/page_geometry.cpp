#include "page/page_geometry.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "page/view_grid.hpp"

namespace isoweave::cli {
namespace {

using PackedVertex = std::array<std::uint16_t, 4>;  // x, y, z, distance

constexpr std::uint32_t kUnused = ~std::uint32_t{0};

double largest(const std::vector<float>& distances) {
  return distances.empty() ? 0 : double{*std::max_element(distances.begin(), distances.end())};
}

// Orders triangles so that they pack well, and renumbers their vertices. Returns the number of these.
std::size_t reorder(const TriangleMesh& mesh, std::vector<std::uint32_t>& indices,
                    std::vector<std::uint32_t>& numbers) {
  indices.resize(mesh.triangles.size() * 3);
  numbers.resize(mesh.vertices.size());
  meshopt_optimizeVertexCache(indices.data(), mesh.triangles.front().data(), indices.size(), mesh.vertices.size());
  const std::size_t used =
      meshopt_optimizeVertexFetchRemap(numbers.data(), indices.data(), indices.size(), mesh.vertices.size());
  meshopt_remapIndexBuffer(indices.data(), indices.data(), indices.size(), numbers.data());
  return used;
}

std::string packed_vertices(const PageSurface& surface, const ViewGrid& grid, const std::vector<std::uint32_t>& numbers,
                            std::size_t used) {
  const double far = largest(surface.distances);
  std::vector<PackedVertex> vertices(used);
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    if (numbers[n] == kUnused) continue;
    const GridPoint place = grid.place(surface.mesh.vertices[n]);
    const double part = far > 0 ? double{surface.distances[n]} / far : 0;
    vertices[numbers[n]] = {place[0], place[1], place[2],
                            static_cast<std::uint16_t>(std::round(part * ViewGrid::kSteps))};
  }
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(used, sizeof(PackedVertex)));
  const std::size_t size =
      meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices.data(), used, sizeof(PackedVertex));
  return base64(std::span(bytes).first(size));
}

std::string packed_indices(const std::vector<std::uint32_t>& indices, std::size_t used) {
  std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(indices.size(), used));
  const std::size_t size = meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size());
  return base64(std::span(bytes).first(size));
}

}  // namespace

std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(bytes.size() - i, 3);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8U | (k < count ? bytes[i + k] : 0U);
    for (std::size_t digit = 0; digit < 4; ++digit) {
      text += digit <= count ? kDigits[word >> (18 - 6 * digit) & 63U] : '=';
    }
  }
  return text;
}

Json packed_surface(PageSurface surface) {
  const ViewGrid grid = ViewGrid::around(surface.mesh.vertices);
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> numbers;
  const std::size_t used = reorder(surface.mesh, indices, numbers);
  surface.mesh.triangles = {};
  std::array<double, 3> origin = grid.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) origin[axis] += surface.mesh.offset[axis];
  return {{"vertices", used},
          {"triangles", indices.size() / 3},
          {"origin", origin},
          {"step", grid.step},
          {"distance", surface.distances.empty() ? Json(nullptr) : Json(largest(surface.distances))},
          {"vertex_data", packed_vertices(surface, grid, numbers, used)},
          {"index_data", packed_indices(indices, used)}};
}

}  // namespace isoweave::cli
