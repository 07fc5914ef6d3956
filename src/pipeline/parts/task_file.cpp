#include "pipeline/parts/task_file.hpp"

#include "isoweave/error.hpp"
#include "system/file_facts.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kMagic = 0x6b73617465766f77;  // "wovetask", little-endian
constexpr std::uint32_t kVersion = 4;
constexpr std::uint64_t kLeastPiece = 48;  // bytes: the lengths of five lists, and a count

void require_same(const StateReader& state, const char* what, const std::string& found, const std::string& expected) {
  if (found == expected) return;
  throw BadInput(state.path() + ": belongs to another mesh: expected the " + what + " " + expected + ", found " +
                 found);
}

}  // namespace

void TaskIdentity::write(StateWriter& state, std::uint64_t task) const {
  state.value(kMagic);
  state.value(kVersion);
  state.list(run.volume);
  state.list(run.options);
  state.value(block);
  state.value(first);
  state.value(head_start);
  state.value(task);
}

TaskIdentity TaskIdentity::read(StateReader& state) {
  std::uint64_t magic = 0;
  std::uint32_t version = 0;
  TaskIdentity found;
  state.value(magic);
  state.value(version);
  state.require(magic == kMagic && version == kVersion, "a file of a task of this version");
  state.list(found.run.volume);
  state.list(found.run.options);
  state.value(found.block);
  state.value(found.first);
  state.value(found.head_start);
  return found;
}

void TaskIdentity::require(StateReader& state, std::uint64_t task) const {
  const TaskIdentity found = read(state);
  std::uint64_t found_task = 0;
  state.value(found_task);
  require_same(state, "volume", found.run.volume, run.volume);
  require_same(state, "options", found.run.options, run.options);
  require_same(state, "size of blocks", std::to_string(found.block), std::to_string(block));
  require_same(state, "task", std::to_string(found_task), std::to_string(task));
  state.require(found.head_start == head_start, "the head start of the plan");
  state.require(found.first == first, "the place of blocks");
}

void TaskFacts::write(StateWriter& state) const {
  state.value(counts);
  state.list(levels);
  state.list(parts);
}

void TaskFacts::read(StateReader& state, std::size_t level_count) {
  state.value(counts);
  state.list(levels);
  state.list(parts);
  state.require(levels.size() == level_count, "the levels of the mesh");
  for (const LevelCounts& level : levels) {
    state.require(level.vertices <= std::uint64_t{1} << kPlaceBits, "vertices that can be numbered");
  }
}

std::string final_file(const std::string& folder, std::uint64_t task) {
  return folder + "/" + std::to_string(task) + ".final";
}

std::string rest_file(const std::string& folder, std::uint64_t task) {
  return folder + "/" + std::to_string(task) + ".rest";
}

bool has_result(const std::string& folder, std::uint64_t task) {
  return system::facts_of_file(final_file(folder, task)) && system::facts_of_file(rest_file(folder, task));
}

namespace {

// The fields of a piece, written or read.
template <class State, class Piece>
void serialize_piece(State& state, Piece& piece) {
  state.list(piece.known);
  state.list(piece.positions);
  state.list(piece.normals);
  state.list(piece.values);
  state.list(piece.triangles);
  state.value(piece.open_edges);
}

void read_final_piece(StateReader& state, FinalPiece& piece) {
  serialize_piece(state, piece);
  const std::size_t vertices = piece.known.size() + piece.positions.size();
  const auto fits = [&](std::size_t count) { return count == 0 || count == piece.positions.size(); };
  state.require(fits(piece.normals.size()) && fits(piece.values.size()), "a normal and a value for each vertex");
  for (const auto& triangle : piece.triangles) {
    for (const std::uint32_t corner : triangle) state.require(corner < vertices, "triangles of the vertices there are");
  }
}

}  // namespace

void write_final_pieces(StateWriter& state, const std::vector<FinalPiece>& pieces) {
  state.value(static_cast<std::uint64_t>(pieces.size()));
  for (const FinalPiece& piece : pieces) serialize_piece(state, piece);
}

void read_final_pieces(StateReader& state, std::vector<FinalPiece>& pieces) {
  pieces.resize(state.count(kLeastPiece));
  for (FinalPiece& piece : pieces) read_final_piece(state, piece);
}

}  // namespace isoweave
