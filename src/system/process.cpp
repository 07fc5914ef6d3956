#include "system/process.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

namespace isoweave::system {

int process_number() { return static_cast<int>(::getpid()); }

int processors() {
#ifdef CPU_COUNT
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof allowed, &allowed) == 0) return std::max(CPU_COUNT(&allowed), 1);
#endif
  return std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
}

}  // namespace isoweave::system
