#include "system/process.hpp"

#include <unistd.h>

namespace isoweave::system {

int process_number() { return static_cast<int>(::getpid()); }

}  // namespace isoweave::system
