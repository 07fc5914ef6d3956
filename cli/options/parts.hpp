// Several surfaces of one run: iso-values or labels, each in a file of its own, or all as the parts of one file
// (--one-file).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"
#include "options/output_mesh.hpp"

namespace isoweave::cli {

// The colour of part n where nothing else gives it one: red, green and blue, 0 to 1. Each differs clearly from those
// before it, and is the same in every run.
std::array<double, 3> part_color(std::size_t n);

// "#rrggbb".
std::string color_text(std::span<const double> color);

// One of the surfaces: where it goes, and what it is called and looks like as a part. Its output is that of the whole
// file where one file has them all.
struct SurfaceOutput {
  OutputOptions output;
  MeshPart part;

  // The name of the surface in messages.
  std::string name() const;
};

// The output of a surface: a.ply becomes a_WORD.ply, but stays as it is where one file has them all.
OutputOptions surface_output(const OutputOptions& output, std::string_view word);

// Refuses a file that cannot hold several parts: iso-values, or labels.
void check_parts(const OutputOptions& output, bool of_labels);

// Opens the files of all surfaces: a sink for each, in their order.
std::vector<std::unique_ptr<MeshSink>> open_surfaces(std::span<const SurfaceOutput> surfaces);

// Gives the reports of the surfaces, and of all of them together, the digests of the meshes as they are in their
// files, which may be placed.
void tell_digests(std::span<const std::unique_ptr<MeshSink>> files, std::span<MeshReport> surfaces, MeshReport& total);

}  // namespace isoweave::cli
