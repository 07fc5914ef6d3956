// Marks of where the axes of a mesh point, in the lower left corner of a picture.
#pragma once

#include <optional>
#include <string>

#include "render/camera.hpp"

namespace isoweave::render {

constexpr int kLeastSideWithAxes = 72;  // pixels, of a picture that has room for the marks

// Draws the axes as the camera sees them. In LPS and RAS both ends have the letters of a patient's sides, else the
// upper end has x, y or z. An end that points away is faint. One that points along the view has no letter.
// @pre No side of the picture is shorter than kLeastSideWithAxes.
void draw_axes(Picture& picture, const Camera& camera, const std::string& space,
               const std::optional<Colour>& background);

}  // namespace isoweave::render
