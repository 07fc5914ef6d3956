// isoweave-mpi: the command line by the ranks of MPI.
#include "mpi_link.hpp"
#include "program.hpp"
#include "ranks.hpp"

int main(int argc, char** argv) {
  isoweave::mpi::MpiLink link(argc, argv);
  isoweave::cli::use_ranks(link);
  const int code = isoweave::cli::run_program(argc, argv);
  link.close();
  return code;
}
