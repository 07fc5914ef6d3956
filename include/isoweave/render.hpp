// Pictures of meshes, by a rasteriser of our own: no display, no device.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// A colour in sRGB, 8 bits each.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Colour&) const = default;
};

// The place of the camera, in degrees around the middle of the mesh. At 0, 0 it looks along +y with z up, in a mesh
// whose space is RAS along -y: both at the face of a patient who stands. Azimuth turns it to the side of +x (RAS: -x),
// elevation up to +z. With another axis up all directions are turned with it, by the least turn from z: with y up the
// camera looks along -z, in RAS along +z.
struct View {
  double azimuth = 35;
  double elevation = 20;  // -90 ... 90
};

// An axis of a mesh's coordinates, or its opposite.
enum class Axis : std::uint8_t { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

enum class Shading : std::uint8_t { kSmooth, kFlat };

struct RenderOptions {
  int width = 1200, height = 900;  // pixels, 1 ... 16384
  View view{};
  Axis up = Axis::kZ;                                        // points up in the picture
  double zoom = 1;                                           // 0.01 ... 100; at 1 the mesh just fits into the frame
  std::optional<Colour> background = Colour{255, 255, 255};  // none: transparent
  Colour colour{222, 205, 180};
  Shading shading = Shading::kSmooth;  // by the mesh's normals, or means of the triangles' around a vertex
  bool wireframe = false;              // edges drawn over the surface
  bool axes = false;                   // marks of the axes in the lower left corner; from 72 x 72 pixels on
  int samples = 3;                     // along each side of a pixel, 1 ... 8
  int threads = 0;                     // 0: all

  // With `quality`: the values at the ends of the colour map; none: the least and the largest finite ones.
  std::optional<std::array<double, 2>> range{};
};

// A picture: rows from the top, pixels from the left. Alpha is not multiplied into the colours.
struct Picture {
  std::int64_t width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 4>> pixels;  // red, green, blue, alpha
};

// Draws a mesh in perspective, as large as fits into the frame, or larger by the zoom. Every sample shows the nearest
// triangle, of equally near ones the first. Lights stand around the camera, both sides are lit, and places between near
// parts are darker (ambient obscurance in screen space: McGuire and others 2011). `quality`: a number for each vertex,
// shown by the colour map viridis (Smith, van der Walt 2015) in place of the colour. Numbers that are not finite take
// the colour. Marks of the axes have the letters of a patient's sides (R L A P S I) in LPS and RAS, else x, y and z.
// @throws std::invalid_argument for a mesh without triangles or with 2^32 of them, indices out of range, coordinates
//   that are not finite, normals or `quality` of another number than the vertices, and options out of range
// @cost Time grows with triangles and samples. Memory: 8 bytes per sample, 4 per pixel and, for smooth shading, 36 per
//   vertex.
// @determinism The same picture for any number of threads.
Picture render_mesh(const TriangleMesh& mesh, const RenderOptions& options = {}, std::span<const float> quality = {});

// The least and the largest of the finite numbers: the range that a picture takes where its options name none. The
// first is larger than the second where there are none.
std::array<double, 2> finite_range(std::span<const float> numbers);

// A picture with a strip at its right that tells the colours of numbers: a bar of them, with the least number, the
// middle and the largest beside it, to four digits. The strip is as wide as colour_bar_width(height), in pixels.
// background: as in the options of the picture
// @pre The numbers of `range` are finite.
Picture with_colour_bar(const Picture& picture, const std::array<double, 2>& range,
                        const std::optional<Colour>& background);
std::int64_t colour_bar_width(std::int64_t height);

// Refuses a file that write_png could not write, before a picture is made in vain.
// @throws CannotWrite as write_png
void require_png(const std::string& path);

// Writes a picture as PNG of 8 bits, without alpha where all pixels are opaque. The file is complete or absent.
// @throws CannotWrite where the file cannot be written, and in builds without libpng
void write_png(const std::string& path, const Picture& picture);

}  // namespace isoweave
#pragma GCC visibility pop
