// Surfaces as a page holds them: packed by meshoptimizer, as base64.
#pragma once

#include <span>
#include <string>

#include "page/page_surfaces.hpp"
#include "report/report.hpp"

namespace isoweave::cli {

std::string base64(std::span<const unsigned char> bytes);

// The fields that the script needs to unpack a surface:
//   vertices, triangles       counts
//   origin, step              position = origin + step * stored
//   distance                  distance of a vertex = distance * stored / 65535; null without distances
//   vertex_data, index_data   base64 of meshoptimizer's vertex buffer (four uint16 each: x, y, z, distance) and of its
//                             index buffer
Json packed_surface(PageSurface surface);

}  // namespace isoweave::cli
