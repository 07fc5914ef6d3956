#include "task.hpp"

namespace bench {

Contestants all_contestants() {
  Contestants contestants;
  add_isoweave(contestants);
  add_memory_floor(contestants);
#ifdef BENCH_MESHOPTIMIZER
  add_meshoptimizer(contestants);
  add_meshoptimizer_slabs(contestants);
#else
  contestants.absent.push_back("meshoptimizer");
#endif
#ifdef BENCH_VTK
  add_vtk_extraction(contestants);
  add_vtk_simplification(contestants);
  add_vtk_jobs(contestants);
#else
  contestants.absent.push_back("VTK");
#endif
#ifdef BENCH_VTK_MESHOPTIMIZER
  add_vtk_meshoptimizer_job(contestants);
#endif
#ifdef BENCH_CGAL
  add_cgal(contestants);
#else
  contestants.absent.push_back("CGAL");
#endif
#ifdef BENCH_OPENMESH
  add_openmesh(contestants);
#else
  contestants.absent.push_back("OpenMesh");
#endif
  return contestants;
}

}  // namespace bench
