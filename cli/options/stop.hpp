// When the simplification of mesh and simplify stops: at an error, at several, or at a number of triangles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "options/cli_app.hpp"
#include "options/lengths.hpp"

namespace isoweave::cli {

struct StopOptions {
  std::string error, triangles, ratio;  // as given; empty: not
  std::string specks = "keep";
  std::string lods;          // errors with commas between them
  std::string max_distance;  // empty: none

  // Whether any option says where to stop.
  bool given() const { return !error.empty() || has_number() || has_levels() || !max_distance.empty(); }
  bool has_number() const { return !triangles.empty() || !ratio.empty(); }
  bool has_levels() const { return !lods.empty(); }
};

void add_stop_options(CLI::App& verb, StopOptions& stop);

// `usual` is the error where no option is given. Where only a guaranteed distance is given, that is the error. Where
// only a number of triangles is given, the error is infinite, in place of which most_shape_error() is taken; "inf"
// beside one of these stays infinite.
Length stop_error(const StopOptions& stop, const std::string& usual, const LengthBasis& basis);

// The options of each level of detail, finest first, as they would be for that mesh alone.
std::vector<StopOptions> stop_levels(const StopOptions& stop);

// All lengths that were given, by their options.
std::vector<GivenLength> given_lengths(const StopOptions& stop);

bool drops_specks(const StopOptions& stop);

// The guaranteed distance; 0: none is asked for.
Length stop_distance(const StopOptions& stop, const LengthBasis& basis);

// Sets the number of triangles, or the share of those of the full surface, at which a run stops.
void set_number(const StopOptions& stop, SimplifyOptions& options);

// Prints how a run to a number of triangles ended: the error that it reached and, where more triangles are left than
// were asked for, the ways to leave fewer. Prints nothing for a run to an error.
void print_target(const StopOptions& stop, const MeshReport& report, const Length& allowed, const std::string& unit);

// "error 0.2vox", "triangles 20000", or both; "ratio 10%"; and "specks drop".
std::string stop_text(const StopOptions& stop, const std::string& usual);

}  // namespace isoweave::cli
