// Serves a page and answers to it on this machine, in threads of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "watch_feed.hpp"

namespace isoweave::cli {

// On 127.0.0.1 only. What it shows may be a patient: an address holds 128 random bits, without which there is nothing
// (404) for the other users and programs of the machine; a name that somebody has pointed to this machine is refused
// (403: DNS rebinding); no other origin may read or frame it. Connections that have not asked within a second and
// 16 KiB, those that take nothing for two, and those that have not taken all in a minute, are closed. Whoever is idle
// holds no thread (watch_connections.hpp); four are answered at a time.
class WatchServer {
 public:
  using Visited = std::function<void()>;
  using Answer = std::function<std::string(const WatchQuery&)>;

  // Port 0: any that is free. `visited`, when the page is sent, and `answer` are called by any of its threads. Throws
  // std::runtime_error when the port cannot be had.
  WatchServer(int port, std::string page, Visited visited, Answer answer);

  // Cuts off whoever is being served.
  ~WatchServer();
  WatchServer(const WatchServer&) = delete;
  WatchServer& operator=(const WatchServer&) = delete;

  std::string url() const;

  // Nobody is being served.
  bool is_idle() const;

 private:
  class Http;

  std::unique_ptr<Http> http_;
};

}  // namespace isoweave::cli
