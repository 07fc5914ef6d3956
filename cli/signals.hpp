// What Ctrl-C, SIGTERM and the end of the terminal (SIGHUP) do. A second one always ends the program at once.
#pragma once

#include <atomic>

namespace isoweave::cli {

// Writing to a closed pipe, or past a limit on the size of files, is an error like others and not the end.
void ignore_write_signals();

// Takes the place of standard streams that were closed by whoever started the program, so that no file of its own gets
// their numbers. Nothing can be written to what stands there.
void occupy_standard_streams();

// End with exit code 130: for verbs, and parts of verbs, that have nothing to clean up.
void exit_on_signal();

// Set a flag for the run to see.
const std::atomic<bool>& stop_on_signal();

}  // namespace isoweave::cli
