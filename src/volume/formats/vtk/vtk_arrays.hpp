// The choice of the array of a VTK file that is the volume, and the types of samples by VTK's names.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

struct VtkArrayName {
  std::string name;
  std::int64_t components = 1;
};

// The arrays at points, or those in cells.
struct VtkArrayNames {
  std::string active;  // the scalars that are shown; empty: none
  std::vector<VtkArrayName> all;
};

struct VtkChoice {
  bool cells = false;
  std::size_t array = 0;
};

// Whether an array is the one: of the name that is wanted or, where none is, active or, where none is active, of one
// component and none of VTK's own.
bool would_choose(const VtkArrayNames& names, const VtkArrayName& array, std::string_view wanted);

// The first array at points that would be chosen, or else the first in cells. Throws BadInput naming all that there are
// when there is none of one component.
VtkChoice choose_vtk_array(const VtkArrayNames& points, const VtkArrayNames& cells, std::string_view wanted,
                           const std::string& path);

// Notes the arrays that the choice leaves out.
void note_vtk_choice(VolumeInfo& info, const VtkArrayNames& points, const VtkArrayNames& cells,
                     const VtkChoice& choice);

}  // namespace isoweave
