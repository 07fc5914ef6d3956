// Slices at uneven distances: what is reported about them, and a stream that resamples them at an even distance.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "files/byte_stream.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

// The places of slices along the normal of their planes, ascending.
struct SlicePlaces {
  std::string path;  // of all of them, for messages
  std::vector<double> depths;
  std::function<std::string(std::size_t)> name;  // of a slice, for messages about several
  std::function<std::string(std::size_t)> file;  // its whole path
  double rounding = 0;                           // of the depths, where they are written in few digits
  std::string unit = " mm";                      // of the depths, behind lengths in messages
};

// A grid of slices at an even distance. Its first and last slice lie where the first and the last slice of the input
// do.
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

// The grid that slices are read on. Adds notes about slices that seem to be missing or do not lie on the grid. Throws
// BadInput when two slices lie in one place, when slices are uneven and uneven ones are refused, and when a gap is much
// too wide to be filled.
EvenGrid even_grid(const SlicePlaces& places, UnevenSlices uneven, std::vector<std::string>& notes);

// The slices of a grid, each linear between the two nearest slices of `slices`. Integers are rounded to the nearest,
// halves upwards. Holds two slices and the one between them that is handed out.
std::unique_ptr<ByteStream> even_slices(std::unique_ptr<ByteStream> slices, const EvenGrid& grid, SampleType type,
                                        std::size_t slice_bytes);

}  // namespace isoweave
