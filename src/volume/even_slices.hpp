// Slices that do not lie at an even distance: what is said of them, and a stream of slices that do, made on the way.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "files/byte_stream.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

// Where slices lie along the normal of their planes, ascending.
struct SlicePlaces {
  std::string path;  // of all of them, for messages
  std::vector<double> depths;
  std::function<std::string(std::size_t)> name;  // of a slice, for messages about several
  std::function<std::string(std::size_t)> file;  // its whole path
  double rounding = 0;                           // of the depths, where they are written in few digits
  std::string unit = " mm";                      // of the depths, behind lengths in messages
};

// Slices at an even distance, the first and the last of them in the places of the first and the last that there are.
struct EvenGrid {
  struct Place {
    std::int64_t lower = 0;
    double weight = 0;  // of the slice above; below 1, and 0 where the place is that of `lower`
  };

  std::vector<double> depths;  // of the slices that there are
  std::int64_t count = 0;
  double slack = 0;           // as little as a slice may lie beside its place without being moved there
  bool is_resampled = false;  // else the slices are taken as they are

  double distance() const;
  Place place(std::int64_t slice) const;
};

// The grid that slices are read on, and notes about slices that seem to be missing or do not lie on it. Throws BadInput
// when two slices lie in one place; when they are uneven and to be refused; and when a gap is much too wide to be
// filled.
EvenGrid even_grid(const SlicePlaces& places, UnevenSlices uneven, std::vector<std::string>& notes);

// The slices of a grid, linear between the two nearest ones of `slices`; integers are rounded to the nearest, halves
// upwards. Holds two slices and the one between them that is handed out.
std::unique_ptr<ByteStream> even_slices(std::unique_ptr<ByteStream> slices, const EvenGrid& grid, SampleType type,
                                        std::size_t slice_bytes);

}  // namespace isoweave
