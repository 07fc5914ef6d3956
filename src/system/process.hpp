// The process among others.
#pragma once

namespace isoweave::system {

// The number by which the system, and whoever looks at its processes, knows this one.
int process_number();

// How many processors it may run on, at least 1.
int processors();

}  // namespace isoweave::system
