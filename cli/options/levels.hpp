// Levels of detail of mesh and simplify (--lods): several meshes from one sweep, each in a file of its own or all in
// one.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "options/output_mesh.hpp"
#include "options/stop.hpp"
#include "report/report.hpp"

namespace isoweave::cli {

// The errors of all levels but the last one.
std::vector<Length> finer_levels(const StopOptions& stop, const LengthBasis& basis);

// The output of each level, finest first: a.ply becomes a_lod0.ply, a_lod1.ply, ... The output stays as it is where no
// levels are asked for, and for each level where one file has them all. Refuses formats that cannot hold several
// levels.
std::vector<OutputOptions> level_outputs(const OutputOptions& output, const StopOptions& stop);

// Opens the files of all levels and discards them: an error that would keep them from being written is found now,
// before anything is read or computed in vain.
void try_levels(const std::vector<OutputOptions>& outputs);

// The files of all levels, open.
class LevelSinks {
 public:
  // options(level): how a level's file is written.
  LevelSinks(const std::vector<OutputOptions>& outputs, const std::function<MeshFileOptions(std::size_t)>& options);

  std::span<MeshSink* const> pointers() const { return pointers_; }
  const MeshSink& last() const { return *sinks_.back(); }

  // Gives the report the digests of the meshes as they are in their files.
  void tell_digests(MeshReport& report) const;

 private:
  std::vector<std::unique_ptr<MeshSink>> sinks_;
  std::vector<MeshSink*> pointers_;
};

// The meshes in the files of all levels but the last one.
std::vector<TriangleMesh> read_finer(const std::vector<OutputOptions>& outputs);

// The counts of the finer levels for the report, and a line for each.
Json levels_json(const MeshReport& report, const std::vector<OutputOptions>& outputs);
void print_levels(const MeshReport& report, const std::vector<OutputOptions>& outputs);

}  // namespace isoweave::cli
