// The effect of Ctrl-C, SIGTERM and the end of the terminal (SIGHUP). A second signal always ends the program at once.
#pragma once

#include <atomic>

namespace isoweave::cli {

// Makes writing to a closed pipe, or past a limit on the size of files, an error like others, instead of the end.
void ignore_write_signals();

// Opens /dev/null for the standard streams that the parent closed, so that no file of the program gets their numbers.
// Nothing can be written to these streams.
void occupy_standard_streams();

// Makes signals end the program with exit code 130: for verbs, and parts of verbs, that have nothing to clean up.
void exit_on_signal();

// Makes signals set a flag for the run to see.
const std::atomic<bool>& stop_on_signal();

// The same flag, which stays as it is where signals do something else.
const std::atomic<bool>& stop_flag();

}  // namespace isoweave::cli
