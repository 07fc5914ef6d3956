// How final triangles leave a zone on a device: HandOver's passes in their order, and the arrays that they fill.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "device/device_arrays.hpp"
#include "device/final_passes.hpp"

namespace isoweave {

template <class Device>
class BulkHandOver {
 public:
  // Takes the final triangles out of a zone, which must be compacted some time. Returns their number.
  std::uint32_t take(Device& device, const ZoneView& zone, const Receipt& first, FinalPiece& piece) {
    find(device, zone);
    passes_.first_new = first;
    list(device);
    read_all(device, out_known_, piece.known);
    read_all(device, out_positions_, piece.positions);
    read_all(device, out_normals_, piece.normals);
    read_all(device, out_triangles_, piece.triangles);
    FinalTotals closed = device.template sum<&FinalPasses::close_sides, FinalTotals>(triangle_count_, passes_);
    piece.open_edges = closed.open_edges;
    device.template for_each<&FinalPasses::drop>(triangle_count_, passes_);
    return triangle_count_;
  }

  SurfaceDefects defects;  // of all vertices that have become final

  std::uint64_t bytes() const {
    return sum_bytes(status_, corners_, triangle_place_, new_place_, known_place_, final_triangles_, final_vertices_,
                     out_known_, out_positions_, out_normals_, out_triangles_);
  }

 private:
  template <class T>
  using Buffer = typename Device::template Buffer<T>;

  // Finds the vertices and triangles that have become final.
  void find(Device& device, const ZoneView& zone) {
    const std::size_t vertices = zone.vertices.size();
    const std::size_t triangles = zone.triangles.size();
    status_.resize(vertices);
    corners_.resize(vertices);
    new_place_.resize(vertices + 1);
    known_place_.resize(vertices + 1);
    triangle_place_.resize(triangles + 1);
    passes_ = FinalPasses();
    passes_.zone = zone;
    passes_.status = status_.data();
    passes_.corners = corners_.data();
    passes_.triangle_place = triangle_place_.data();
    passes_.new_place = new_place_.data();
    passes_.known_place = known_place_.data();
    device.template for_each<&FinalPasses::name_vertex>(signed_count(vertices), passes_);
    device.template for_each<&FinalPasses::name_triangle>(signed_count(triangles), passes_);
    defects += device.template sum<&FinalPasses::inspect, FinalTotals>(signed_count(vertices), passes_).defects;
    device.scan(triangle_place_, triangles);
    device.scan(new_place_, vertices);
    device.scan(known_place_, vertices);
    triangle_count_ = read_one(device, triangle_place_.data() + triangles);
    new_count_ = read_one(device, new_place_.data() + vertices);
    passes_.known_vertices = read_one(device, known_place_.data() + vertices);
  }

  // Lists the final triangles and their vertices for the host.
  void list(Device& device) {
    const ZoneView& zone = passes_.zone;
    const std::size_t vertices = std::size_t{passes_.known_vertices} + new_count_;
    final_triangles_.resize(triangle_count_);
    final_vertices_.resize(vertices);
    out_known_.resize(passes_.known_vertices);
    out_positions_.resize(new_count_);
    out_normals_.resize(zone.normals.empty() ? 0 : new_count_);
    out_triangles_.resize(triangle_count_);
    passes_.final_triangles = final_triangles_.data();
    passes_.final_vertices = final_vertices_.data();
    passes_.out_known = out_known_.data();
    passes_.out_positions = out_positions_.data();
    passes_.out_normals = zone.normals.empty() ? nullptr : out_normals_.data();
    passes_.out_triangles = out_triangles_.data();
    device.template for_each<&FinalPasses::list_triangle>(signed_count(zone.triangles.size()), passes_);
    device.template for_each<&FinalPasses::list_vertex>(signed_count(zone.vertices.size()), passes_);
    device.template for_each<&FinalPasses::write_triangle>(triangle_count_, passes_);
    device.template for_each<&FinalPasses::write_vertex>(signed_count(vertices), passes_);
  }

  FinalPasses passes_;
  Buffer<std::uint32_t> status_, corners_, triangle_place_, new_place_, known_place_;
  Buffer<Index> final_triangles_, final_vertices_;
  Buffer<KnownVertex> out_known_;
  Buffer<Vec3> out_positions_;
  Buffer<Point> out_normals_;
  Buffer<std::array<std::uint32_t, 3>> out_triangles_;
  std::uint32_t triangle_count_ = 0, new_count_ = 0;
};

}  // namespace isoweave
