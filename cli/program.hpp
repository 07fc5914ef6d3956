// The command line as a whole.
#pragma once

namespace isoweave::cli {

// Runs the program with the arguments of main(). Every error is one line and an exit code, which is returned.
int run_program(int argc, char** argv);

}  // namespace isoweave::cli
