#include "mpi_link.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace isoweave::mpi {
namespace {

// MPI counts in int, so long messages are sent in pieces.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr int kLastPiece = 0;
constexpr int kPiece = 1;

constexpr std::chrono::microseconds kPause{200};
constexpr int kPauses = 10;

}  // namespace

MpiLink::MpiLink(int& argc, char**& argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}

void MpiLink::send(int to, std::vector<std::byte> message) {
  drop_sent();
  Sending& sending = sending_.emplace_back();
  sending.bytes = std::move(message);
  std::size_t first = 0;
  do {
    const std::size_t count = std::min(kMostBytes, sending.bytes.size() - first);
    const bool is_last = first + count == sending.bytes.size();
    MPI_Isend(sending.bytes.data() + first, static_cast<int>(count), MPI_BYTE, to, is_last ? kLastPiece : kPiece,
              MPI_COMM_WORLD, &sending.requests.emplace_back());
    first += count;
  } while (first < sending.bytes.size());
}

std::optional<RankMessage> MpiLink::receive() {
  drop_sent();
  while (true) {
    int found = 0;
    MPI_Message piece{};
    MPI_Status status{};
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &found, &piece, &status);
    if (found == 0) return std::nullopt;
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    std::vector<std::byte>& bytes = begun_[status.MPI_SOURCE];
    const std::size_t first = bytes.size();
    bytes.resize(first + static_cast<std::size_t>(count));
    MPI_Mrecv(bytes.data() + first, count, MPI_BYTE, &piece, MPI_STATUS_IGNORE);
    if (status.MPI_TAG == kLastPiece) return RankMessage{status.MPI_SOURCE, std::exchange(bytes, {})};
  }
}

void MpiLink::pause() {
  for (int n = 0; n < kPauses; ++n) {
    int found = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &found, MPI_STATUS_IGNORE);
    if (found != 0) return;
    std::this_thread::sleep_for(kPause);
  }
}

// Forgets messages that have been sent.
void MpiLink::drop_sent() {
  sending_.remove_if([](Sending& sending) {
    int done = 0;
    MPI_Testall(static_cast<int>(sending.requests.size()), sending.requests.data(), &done, MPI_STATUSES_IGNORE);
    return done != 0;
  });
}

// A rank stands at the barrier once its own messages have been taken in (Hoefler, Siebert, Lumsdaine 2010).
void MpiLink::close() {
  MPI_Request barrier = MPI_REQUEST_NULL;
  for (int done = 0; done == 0; pause()) {
    while (receive()) {
    }
    if (barrier == MPI_REQUEST_NULL && sending_.empty()) MPI_Ibarrier(MPI_COMM_WORLD, &barrier);
    if (barrier != MPI_REQUEST_NULL) MPI_Test(&barrier, &done, MPI_STATUS_IGNORE);
  }
  MPI_Finalize();
}

}  // namespace isoweave::mpi
