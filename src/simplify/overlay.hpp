// How high the faces that a collapse leaves lie above those that were there: what is known of the distance of the old
// ones holds for the new ones with that height added.
#pragma once

#include <array>
#include <cstddef>

#include "simplify/face_bounds.hpp"
#include "simplify/kernels.hpp"
#include "simplify/star.hpp"

namespace isoweave {

// Both triangulations of the ring around two vertices that merge, seen along a direction from which all their faces
// face up. In each part of their overlay the height of one above the other is linear (Bajaj and Schikore, 1996), and so
// are the bounds of the old faces. So a linear bound holds for a new face where it holds at the corners of these parts:
// at a vertex of one that lies over a face of the other, where two sides cross, and on the ring, where the height is 0.
// There a new face keeps the largest bound of the old ones. Places are measured from the merged vertex.
class Overlay {
 public:
  // No end may be on a border. The zone and the stars must outlive this.
  Overlay(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place);

  // Bounds the new faces. Returns false where no such direction is found: then nothing is known.
  bool bound(FaceBounds& bounds);

 private:
  static constexpr std::size_t kRoom = Star::kRoom;

  struct OldFace {
    std::array<std::size_t, 3> corners;
    std::array<double, 3> bounds;  // there

    double bound_at(std::size_t corner) const {
      return bounds[corner == corners[0] ? 0 : corner == corners[1] ? 1 : 2];
    }
  };

  std::size_t at_u() const { return count_; }
  std::size_t at_v() const { return count_ + 1; }
  std::size_t around_u(std::size_t n) const { return n == 0 ? at_v() : n - 1; }
  std::size_t around_v(std::size_t n) const { return n == 0 ? at_u() : (u_faces_ - 3 + n) % count_; }
  std::size_t after(std::size_t n) const { return n + 1 < count_ ? n + 1 : 0; }
  void list_old_faces(const ZoneView& zone, const Star& u, const Star& v);
  bool look_along(const Vec3& up);
  bool turn_until_faces_face_up(Vec3 up);
  void list_normals();
  bool new_faces_face_up();
  bool old_faces_face_up() const;
  bool see_merged_vertex();
  void list_old_sides();
  bool see_new_faces(FaceBounds& bounds);
  bool see_old_vertex(std::size_t old, std::size_t face, double& merged) const;

  double units_;  // of bounds, in a length
  std::size_t u_faces_, v_faces_;
  std::size_t count_;                      // of the ring's vertices, and of the new faces
  std::array<Vec3, kRoom> places_, seen_;  // of the ring and of both ends; seen: two coordinates across, and the height
  std::array<double, kRoom> bounds_{};     // the largest of the old faces there
  std::array<OldFace, kRoom> old_faces_;
  std::size_t old_count_ = 0;
  std::array<Vec3, kRoom> normals_;  // of the old faces and the new ones
  std::size_t normal_count_ = 0;
  std::array<double, kRoom> areas_;  // of the new faces, as they are seen
  double least_area_ = 0;
  double merged_ = -1;  // the bound at the merged vertex
  SeenSides old_sides_;
};

}  // namespace isoweave
