// The place of a mesh, for all readers: the space, unit and offset that files give, and coordinates of 64 bits.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave::mesh_io {

using WidePoint = std::array<double, 3>;

// The place that a file gives, by names and values: SPACE, UNIT and OFFSET. Of two that differ the first one counts.
class MeshPlace {
 public:
  // Looks for NAME=value among the words of a comment: "3D Slicer output. SPACE=LPS".
  void take_comment(std::string_view comment);

  // Other names are passed over.
  void take(std::string_view name, std::string_view value);

  // The offset of the coordinates, if the file names one. It is a proposal only: set_vertices finds out whether it is
  // of use.
  const std::optional<WidePoint>& offset() const { return offset_; }

  // Fills in space, unit and notes.
  void put_into(TriangleMesh& mesh) const;

 private:
  void take_known(std::string& field, std::string_view name, std::string_view value, std::string_view known);

  std::string space_, unit_;
  std::optional<WidePoint> offset_;
  std::vector<std::string> notes_;
};

// "x,y,z" as MeshFileOptions::offset is written into comments; nothing for other texts.
std::optional<WidePoint> parse_offset(std::string_view text);

// The double that is nearest to the text and that becomes, rounded to 32 bits, the float nearest to the text. Nothing
// where that float is not finite.
std::optional<double> parse_wide(std::string_view text);

// Gives a mesh its vertices, rounded to 32 bits. They are relative to an offset where they would else move by more than
// a thousandth of the root of twice the mean triangle area. The mesh has its triangles already, which name no other
// vertices. `named`: the offset of the file.
void set_vertices(TriangleMesh& mesh, std::span<const WidePoint> points, const std::optional<WidePoint>& named);

// The part of set_vertices that chooses the offset, and adds a note where none helps.
WidePoint offset_for(std::span<const WidePoint> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                     const std::optional<WidePoint>& named, std::vector<std::string>& notes);

// A point relative to an offset, in 32 bits.
Point relative_point(const WidePoint& point, const WidePoint& offset);

}  // namespace isoweave::mesh_io
