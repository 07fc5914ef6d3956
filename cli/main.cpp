#include "program.hpp"

int main(int argc, char** argv) { return isoweave::cli::run_program(argc, argv); }
