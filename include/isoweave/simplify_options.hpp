// Options that the simplification of volumes and of meshes share.
#pragma once

#include <cstdint>

#pragma GCC visibility push(default)
namespace isoweave {

// How much an edge's cost is refined when it is decided. Every quality gives one mesh, whatever the schedule.
//   fast    accumulated quadrics alone
//   normal  the current faces count more, placement preserves volume; an edge dearer than twice its key goes back
//   fine    the same with lower keys, and an edge a tenth dearer than its key goes back: lowest error
enum class Quality : std::uint8_t { kFast, kNormal, kFine };

// Order in which edges are decided; it never changes the result.
//   automatic  local
//   queue      one priority queue in one thread: the sequential reference
//   local      workers follow chains of keys to local minima: the fastest on a CPU, also with one thread
//   rounds     all local minima at a time, in passes over lists: the shape of a device's schedule
enum class Schedule : std::uint8_t { kAutomatic, kQueue, kLocal, kRounds };

}  // namespace isoweave
#pragma GCC visibility pop
