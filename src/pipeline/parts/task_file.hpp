// The two files of a task: `N.final` with its final triangles, and `N.rest` with the parts that are left for the next
// stage. The second one appears when the task is done. In a run to a number of triangles none is final before the end:
// `N.final` has those that the task keeps.
//
// Both begin with the mesh that they are of. A vertex that a task has handed over is known by the number of the task
// and its place among the vertices of that task.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "files/state_file.hpp"
#include "pipeline/run_identity.hpp"
#include "simplify/final_piece.hpp"
#include "simplify/simplify_totals.hpp"
#include "volume/samples.hpp"

namespace isoweave {

// The receipt of a vertex: the task above so many bits, its place below.
inline constexpr unsigned kPlaceBits = 36;

// The mesh that a file belongs to.
struct TaskIdentity {
  RunIdentity run;
  std::int64_t block = 0;
  std::array<std::int64_t, 3> first{0, 0, 0};
  CostBits head_start = kUnknownCost;  // of a run to a number of triangles: what tasks decide costs no more

  void write(StateWriter& state, std::uint64_t task) const;

  // Throws BadInput, with the name of the file, for one of another version, mesh or task.
  void require(StateReader& state, std::uint64_t task) const;

  // The identity in a file. Throws BadInput for one of another version.
  static TaskIdentity read(StateReader& state);
};

// The counts of a level that a task has handed over.
struct LevelCounts {
  std::uint64_t vertices = 0, triangles = 0, open_edges = 0;
  SurfaceDefects defects;
};

// The counts of a task.
struct TaskCounts {
  std::uint64_t cells = 0, triangles_extracted = 0, vertices_extracted = 0;
  std::uint64_t taken = 0;  // triangles with which it began
  std::uint64_t left = 0;   // triangles for the next stage
  std::uint64_t rounds = 0;
  DecisionCounts decisions;
  SampleRange range;
};

// Where a part of what is left goes to: a task of the next stage.
struct TaskPart {
  std::uint64_t task = 0;
  std::uint64_t triangles = 0;
};

// The facts about a task that later tasks and the collection need: its counts, and the tasks that its parts go to.
struct TaskFacts {
  TaskCounts counts;
  std::vector<LevelCounts> levels;
  std::vector<TaskPart> parts;

  void write(StateWriter& state) const;
  void read(StateReader& state, std::size_t level_count);
};

std::string final_file(const std::string& folder, std::uint64_t task);
std::string rest_file(const std::string& folder, std::uint64_t task);
// Whether both files of a task are there.
bool has_result(const std::string& folder, std::uint64_t task);

// The pieces of final triangles of a level.
void write_final_pieces(StateWriter& state, const std::vector<FinalPiece>& pieces);
void read_final_pieces(StateReader& state, std::vector<FinalPiece>& pieces);

}  // namespace isoweave
