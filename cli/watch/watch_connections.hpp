// The connections of --watch. One thread takes requests in, and a few others answer them. Size, time and number of
// connections are bounded, whoever they are.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace isoweave::cli {

// Connections that have not asked hold a socket and the bytes received so far, but no thread. Each has one second in
// all and 16 KiB. When there are too many, the oldest is closed.
class WatchConnections {
 public:
  // The question of a connection: the line of its request and its Host lines. Nothing else of it is looked at.
  struct Question {
    int socket = -1;
    std::string head;
  };
  using Serve = std::function<void(const Question&)>;

  // `serve` answers, in any of four threads. The socket is closed after the answer.
  explicit WatchConnections(Serve serve);

  // Cuts off all connections.
  ~WatchConnections();
  WatchConnections(const WatchConnections&) = delete;
  WatchConnections& operator=(const WatchConnections&) = delete;

  // Takes a new connection. Does not wait.
  void take(int socket);

  // Whether every connection that has asked has its answer.
  bool is_idle() const { return unanswered_ == 0; }

  // Set when the server ends: an answer on its way must be given up.
  const std::atomic<bool>& over() const { return over_; }

 private:
  using Clock = std::chrono::steady_clock;

  struct Asking {
    int socket;
    Clock::time_point until;
    std::string head;
  };
  enum class State { kAsking, kAsked, kGone };

  void take_in();
  void add_new();
  void wait() const;
  State read_some(Asking& asking) const;
  bool hand_over(Asking& asking);
  void answer();

  const Serve serve_;
  std::atomic<bool> over_ = false;
  std::atomic<int> unanswered_ = 0;
  int wake_ = -1;  // an eventfd: there is a new connection, or it is over
  std::mutex mutex_;
  std::condition_variable asked_;
  std::vector<int> new_;            // sockets, between the two threads
  std::deque<Question> questions_;  // asked, and waiting for a thread
  std::vector<Asking> asking_;      // of the thread that takes in
  std::vector<std::thread> threads_;
};

}  // namespace isoweave::cli
