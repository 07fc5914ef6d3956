// Ranks of one process: a thread each, with queues for messages.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "isoweave/ranks.hpp"

namespace isoweave::testing {

class LocalRanks {
 public:
  explicit LocalRanks(int ranks) : queues_(static_cast<std::size_t>(ranks)) {}

  // Calls run(link) for each rank in a thread of its own. Returns what each has thrown, or null.
  template <class Run>
  std::vector<std::exception_ptr> run(const Run& run) {
    std::vector<std::exception_ptr> errors(queues_.size());
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < queues_.size(); ++rank) {
      threads.emplace_back([&, rank] {
        Link link(*this, static_cast<int>(rank));
        try {
          run(link);
        } catch (...) {
          errors[rank] = std::current_exception();
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    return errors;
  }

 private:
  struct Queue {
    std::mutex mutex;
    std::condition_variable arrived;
    std::deque<RankMessage> messages;
  };

  // Messages of different ranks overtake each other at random, as those of a network do.
  class Link final : public RankLink {
   public:
    Link(LocalRanks& ranks, int rank) : ranks_(ranks), rank_(rank), random_(static_cast<unsigned>(rank)) {}

    int rank() const override { return rank_; }
    int ranks() const override { return static_cast<int>(ranks_.queues_.size()); }

    void send(int to, std::vector<std::byte> message) override {
      Queue& queue = ranks_.queues_.at(static_cast<std::size_t>(to));
      const std::scoped_lock lock(queue.mutex);
      queue.messages.push_back({rank_, std::move(message)});
      queue.arrived.notify_one();
    }

    std::optional<RankMessage> receive() override {
      Queue& queue = ranks_.queues_[static_cast<std::size_t>(rank_)];
      const std::scoped_lock lock(queue.mutex);
      if (queue.messages.empty()) return std::nullopt;
      const int from = queue.messages[random_() % queue.messages.size()].from;
      for (auto message = queue.messages.begin();; ++message) {
        if (message->from != from) continue;
        RankMessage found = std::move(*message);
        queue.messages.erase(message);
        return found;
      }
    }

    void pause() override {
      Queue& queue = ranks_.queues_[static_cast<std::size_t>(rank_)];
      std::unique_lock lock(queue.mutex);
      queue.arrived.wait_for(lock, std::chrono::milliseconds(5), [&] { return !queue.messages.empty(); });
    }

   private:
    LocalRanks& ranks_;
    const int rank_;
    std::mt19937 random_;
  };

  std::vector<Queue> queues_;
};

}  // namespace isoweave::testing
