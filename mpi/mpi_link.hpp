// Messages between ranks by MPI.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <list>
#include <map>
#include <vector>

#include "isoweave/ranks.hpp"

namespace isoweave::mpi {

class MpiLink final : public RankLink {
 public:
  // Starts MPI.
  MpiLink(int& argc, char**& argv);

  int rank() const override { return rank_; }
  int ranks() const override { return ranks_; }
  void send(int to, std::vector<std::byte> message) override;
  std::optional<RankMessage> receive() override;
  void pause() override;

  // Ends MPI, when all ranks have come here: until then messages that nobody waits for any more are taken in.
  void close();

 private:
  // A message on its way, in pieces.
  struct Sending {
    std::vector<std::byte> bytes;
    std::vector<MPI_Request> requests;
  };

  void drop_sent();

  int rank_ = 0, ranks_ = 1;
  std::list<Sending> sending_;
  std::map<int, std::vector<std::byte>> begun_;  // per rank: the pieces of its message so far
};

}  // namespace isoweave::mpi
