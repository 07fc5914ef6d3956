// Arrays in the memory of a device, and what is copied from and to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "simplify/zone_view.hpp"

namespace isoweave {

template <class... Buffers>
std::uint64_t sum_bytes(const Buffers&... buffers) {
  return (... + (buffers.capacity() * sizeof(*buffers.data())));
}

inline std::int64_t signed_count(std::size_t count) { return static_cast<std::int64_t>(count); }

template <class Device>
std::uint32_t read_one(Device& device, const std::uint32_t* from) {
  std::uint32_t value = 0;
  device.read(from, 1, &value);
  return value;
}

// Makes a list on the host the same as an array on the device, and the other way round.
template <class Device, class Buffer, class List>
void read_all(Device& device, const Buffer& from, List& to) {
  to.resize(from.size());
  device.read(from.data(), from.size(), to.data());
}
template <class Device, class List, class Buffer>
void write_all(Device& device, const List& from, Buffer& to) {
  to.resize(from.size());
  device.write(from.data(), from.size(), to.data());
}

// The arrays of a zone.
template <class Device>
struct DeviceZone {
  template <class T>
  using Buffer = typename Device::template Buffer<T>;

  Buffer<Vertex> vertices;
  Buffer<VertexState> states;
  Buffer<Point> normals;
  Buffer<Key> turn_keys;
  Buffer<Turn> turns;
  Buffer<Triangle> triangles;

  void resize(std::size_t vertex_count, std::size_t triangle_count, bool has_normals) {
    vertices.resize(vertex_count);
    states.resize(vertex_count);
    normals.resize(has_normals ? vertex_count : 0);
    turn_keys.resize(vertex_count);
    turns.resize(vertex_count);
    triangles.resize(triangle_count);
  }

  std::uint64_t bytes() const { return sum_bytes(vertices, states, normals, turn_keys, turns, triangles); }

  ZoneView view(const ZoneOptions& options) {
    const auto show = [](auto& array) { return std::span(array.data(), array.size()); };
    return {show(vertices), show(states),    show(normals), show(turn_keys),
            show(turns),    show(triangles), options,       options.retire};
  }
};

}  // namespace isoweave
