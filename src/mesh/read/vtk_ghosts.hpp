// Ghost cells: copies of cells of other pieces, and cells that are refined or hidden. VTK does not count them in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mesh/read/vtk_numbers.hpp"

namespace isoweave::mesh_io {

class VtkGhosts {
 public:
  // Whether an array of cells, of one component, says which of them are ghosts. Types have the names of XML files.
  static bool are_in(std::string_view name, std::string_view type) { return name == "vtkGhostType" && type == "UInt8"; }

  VtkGhosts() = default;

  // Takes that array's numbers, of all cells of a piece.
  VtkGhosts(VtkNumbers& numbers, std::uint64_t cells) {
    constexpr std::uint64_t kDuplicate = 1, kRefined = 8, kHidden = 32;
    for (std::uint64_t n = 0; n < cells; ++n) {
      ghosts_.push_back((numbers.index() & (kDuplicate | kRefined | kHidden)) != 0);
    }
  }

  // Whether a cell is a ghost, which is counted.
  bool leave_out(std::uint64_t cell) {
    const bool is_ghost = cell < ghosts_.size() && ghosts_[static_cast<std::size_t>(cell)];
    left_out_ += is_ghost ? 1 : 0;
    return is_ghost;
  }

  std::uint64_t left_out() const { return left_out_; }

 private:
  std::vector<bool> ghosts_;
  std::uint64_t left_out_ = 0;
};

}  // namespace isoweave::mesh_io
