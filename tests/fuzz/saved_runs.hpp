// Small runs that are saved after a slab, for what lies in a state behind its header.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>

#include "files/state_file.hpp"
#include "isoweave/error.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/pipeline.hpp"
#include "pipeline/checkpoint.hpp"
#include "pipeline/run_identity.hpp"

namespace isoweave::fuzz {

inline constexpr std::size_t kSavedRuns = 6;

inline std::unique_ptr<SliceSource> saved_volume() {
  return generate_volume({"noise", {5, 4, 8}, SampleType::kUint8, {1, 1, 1}, 5});
}

inline MeshOptions saved_options(std::size_t run) {
  MeshOptions options;
  options.iso = 127.5;
  options.error = Length::voxels(run == 0 ? 0 : 0.4);
  if (run == 1) options.closed = false;
  if (run == 2) options.levels = {Length::voxels(0.1)};
  if (run == 3) options.max_distance = Length::voxels(0.5);
  if (run == 4) options.normals = Normals::kQuadric;
  if (run == 5) options.values = saved_volume();
  return options;
}

// A sink that can be continued, as nothing is kept.
class ForgetfulSink final : public MeshSink {
 public:
  void append(const MeshPiece&) override {}
  void finish() override {}
  std::string mark() override { return ""; }
};

// Saves a run in a folder after its first slab, or resumes it from there and goes on to the end.
inline void run_saved(std::size_t run, const std::string& folder, bool resume) {
  std::atomic<bool> stop = false;
  const MeshOptions options = saved_options(run);
  RunControl control;
  control.threads = 1;
  control.slab = 3;
  control.stop = borrow(stop);
  if (resume) {
    control.resume = read_checkpoint(folder);
  } else {
    control.progress = [&](const Progress&) { stop = true; };
    control.checkpoint.folder = folder;
  }
  ForgetfulSink fine, coarse;
  MeshSink* const sinks[] = {&fine, &coarse};
  mesh_volume(*saved_volume(), std::span(sinks).last(options.levels.size() + 1), options, control);
}

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A state without its checksum, cut where the header ends.
struct SavedState {
  std::string header;
  std::string body;
};

// The state of a run after its first slab. The folder must be empty, and is so again afterwards.
inline SavedState save_run(std::size_t run, const std::string& folder) {
  constexpr std::size_t kChecksum = sizeof(std::uint32_t);
  try {
    run_saved(run, folder, false);
  } catch (const Interrupted&) {
  }
  const Checkpoint checkpoint = read_checkpoint(folder);
  const std::string whole = bytes_of(checkpoint.path);
  std::filesystem::remove(checkpoint.path);
  const RunIdentity identity = identity_of(resolve(saved_volume()->info(), saved_options(run), {}));
  CheckpointFolder states(folder);
  states.begin_state(checkpoint, identity)->commit();
  const std::size_t header = bytes_of(checkpoint.path).size() - kChecksum;
  states.clear();
  return {whole.substr(0, header), whole.substr(header, whole.size() - header - kChecksum)};
}

// Puts a state with its checksum into a folder.
inline void put_state(const SavedState& state, const std::string& folder) {
  const std::string whole = state.header + state.body;
  const std::uint32_t crc = add_to_crc(0, std::as_bytes(std::span(whole)));
  std::ofstream file(folder + "/state-1", std::ios::binary);
  file << whole << std::string_view(reinterpret_cast<const char*>(&crc), sizeof crc);
}

}  // namespace isoweave::fuzz
