// The process among others.
#pragma once

namespace isoweave::system {

// The number of this process.
int process_number();

// The number of processors that the process may run on, at least 1.
int processors();

}  // namespace isoweave::system
