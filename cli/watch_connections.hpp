// The connections of --watch: what they ask is taken in by one thread, answered by a few others, and bounded in size,
// time and number, whoever they are.
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

// Those that have not asked hold a socket and what came so far, but no thread. They have one second in all and 16 KiB;
// when there are too many, the oldest goes.
class WatchConnections {
 public:
  // What a connection asked: the line of its request and its Host lines. Nothing else of it is looked at.
  struct Question {
    int socket = -1;
    std::string head;
  };
  using Serve = std::function<void(const Question&)>;

  // `serve` answers, in any of four threads; the socket is closed behind it.
  explicit WatchConnections(Serve serve);

  // Cuts off whoever is there.
  ~WatchConnections();
  WatchConnections(const WatchConnections&) = delete;
  WatchConnections& operator=(const WatchConnections&) = delete;

  // A new connection. Does not wait.
  void take(int socket);

  // Nobody who has asked is without the answer.
  bool is_idle() const { return unanswered_ == 0; }

  // It is all over: an answer on its way is to be given up.
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
