// The threads of VTK. On its own, because a header of VTK 9.1 is not C++20.
#pragma once

namespace bench {

// Back ends: "TBB", "STDThread", "Sequential". Throws std::runtime_error when this VTK lacks it.
void use_vtk_threads(const char* backend, int threads);

}  // namespace bench
