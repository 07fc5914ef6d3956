// Loops of a build without threads: everything runs in the calling one, whatever number is wanted.
#include "parallel/arena.hpp"

namespace isoweave {

std::shared_ptr<Arena> Arena::make(int) { return nullptr; }

int Arena::threads_for(int) { return 1; }

}  // namespace isoweave
