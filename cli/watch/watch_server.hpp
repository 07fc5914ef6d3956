// Serves a page and answers to it on this machine, in threads of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "watch/watch_feed.hpp"

namespace isoweave::cli {

// Serves on 127.0.0.1 only. The surface may be a patient's. So the address holds 128 random bits, without which other
// users and programs of the machine find nothing (404). A name that somebody has pointed to this machine is refused
// (403: DNS rebinding). No other origin may read or frame the page. Connections are closed that have not asked within a
// second and 16 KiB, that take nothing for two seconds, or that have not taken everything in a minute. An idle
// connection holds no thread (watch_connections.hpp); four are answered at a time.
class WatchServer {
 public:
  using Visited = std::function<void()>;
  using Answer = std::function<std::string(const WatchQuery&)>;

  // Port 0: any that is free. `visited`, when the page is sent, and `answer` are called by any of its threads. Throws
  // std::runtime_error when the port cannot be had.
  WatchServer(int port, std::string page, Visited visited, Answer answer);

  // Cuts off all connections.
  ~WatchServer();
  WatchServer(const WatchServer&) = delete;
  WatchServer& operator=(const WatchServer&) = delete;

  std::string url() const;

  // Whether no connection is being served.
  bool is_idle() const;

 private:
  class Http;

  std::unique_ptr<Http> http_;
};

}  // namespace isoweave::cli
