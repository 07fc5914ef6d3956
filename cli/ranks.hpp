// The ranks of the program: none in isoweave, those of MPI in isoweave-mpi.
#pragma once

#include "isoweave/ranks.hpp"

namespace isoweave::cli {

// The link of this rank to the others; null in a program of one process.
RankLink* rank_link();

// Makes the program work by ranks. The link must outlive all that follows.
void use_ranks(RankLink& link);

// Whether this process prints and writes: the first rank does, for all of them.
bool speaks();

}  // namespace isoweave::cli
