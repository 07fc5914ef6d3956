#include "watch/watch_server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <random>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "watch/watch_connections.hpp"

namespace isoweave::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kLoopback = "127.0.0.1";
constexpr Clock::duration kToTake = 2s;      // a part of the answer
constexpr Clock::duration kToTakeAll = 60s;  // the address may have been forwarded over a slow line
constexpr int kBetweenLooksAtEnd = 20;       // ms between two looks whether the server ends

// A token of 128 random bits.
std::string random_token() {
  std::random_device random;
  std::string token;
  for (int word = 0; word < 4; ++word) token += fmt::format("{:08x}", random());
  return token;
}

// A request in memory, and the socket that the answer goes to.
class Connection final : public httplib::Stream {
 public:
  Connection(const WatchConnections::Question& question, const std::atomic<bool>& over)
      : question_(question), over_(over) {}

  bool is_readable() const override { return read_ < question_.head.size(); }

  ssize_t read(char* to, std::size_t size) override {
    const std::size_t got = question_.head.copy(to, size, read_);
    read_ += got;
    return static_cast<ssize_t>(got);
  }

  // Looks once more when the time is up: a process that was stopped meanwhile finds data that were taken.
  bool is_writable() const override {
    const Clock::time_point until = std::min(Clock::now() + kToTake, all_taken_by_);
    while (!over_) {
      const bool last = Clock::now() >= until;
      pollfd ready{question_.socket, POLLOUT, 0};
      if (::poll(&ready, 1, last ? 0 : kBetweenLooksAtEnd) > 0) return true;
      if (last) return false;
    }
    return false;
  }

  ssize_t write(const char* from, std::size_t size) override {
    return is_writable() ? ::send(question_.socket, from, size, MSG_DONTWAIT | MSG_NOSIGNAL) : -1;
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip = kLoopback;
    port = 0;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override { get_remote_ip_and_port(ip, port); }
  socket_t socket() const override { return question_.socket; }

 private:
  const WatchConnections::Question& question_;
  const std::atomic<bool>& over_;
  const Clock::time_point all_taken_by_ = Clock::now() + kToTakeAll;
  std::size_t read_ = 0;
};

// A queue that hands each connection on at once.
class HandOn final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> take) override { take(); }
  void shutdown() override {}
};

// Whether a request names this machine, as "127.0.0.1:8080" does. Any port will do: it may have been forwarded.
bool is_this_machine(const httplib::Request& request) {
  if (request.get_header_value_count("Host") != 1) return false;
  const std::string host = request.get_header_value("Host");
  const std::string name = host.substr(0, host.find(':'));
  return name == kLoopback || name == "localhost";
}

template <class Number>
Number number_of(const httplib::Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  Number number{};
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

// Sends content without a copy.
void send(httplib::Response& response, const char* type, std::shared_ptr<const std::string> content) {
  const std::size_t size = content->size();
  response.set_content_provider(
      size, type, [content = std::move(content)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(content->data() + offset, std::min<std::size_t>(length, 65'536));
      });
}

}  // namespace

class WatchServer::Http final : private httplib::Server {
 public:
  Http(int port, std::string page, Visited visited, Answer answer)
      : page_(std::make_shared<const std::string>(std::move(page))),
        visited_(std::move(visited)),
        answer_(std::move(answer)) {
    // Clears httplib's SO_REUSEPORT, by which two processes would share a port.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    set_default_headers({{"Cache-Control", "no-store"},
                         {"Content-Security-Policy", "frame-ancestors 'none'"},
                         {"Cross-Origin-Resource-Policy", "same-origin"},
                         {"Referrer-Policy", "no-referrer"},
                         {"X-Content-Type-Options", "nosniff"}});
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      respond(request, response);
      return HandlerResponse::Handled;
    });
    new_task_queue = [] { return new HandOn; };
    port_ = port == 0 ? bind_to_any_port(kLoopback) : bind_to_port(kLoopback, port) ? port : -1;
    if (port_ < 0) throw std::runtime_error("expected a port that is free, found it taken or not allowed");
    listener_ = std::thread([this] { listen_after_bind(); });
    while (!is_running()) std::this_thread::sleep_for(1ms);
  }

  ~Http() override {
    stop();
    listener_.join();
  }

  bool is_idle() const { return connections_.is_idle(); }

  std::string url() const { return fmt::format("http://{}:{}/{}/", kLoopback, port_, token_); }

 private:
  void respond(const httplib::Request& request, httplib::Response& response) const {
    const std::string home = "/" + token_ + "/";
    if (!is_this_machine(request)) {
      response.status = 403;
    } else if (request.path != home && request.path != home + "news") {
      response.status = 404;
    } else if (request.method != "GET") {
      response.status = 405;
    } else if (request.path == home) {
      visited_();
      send(response, "text/html; charset=utf-8", page_);
    } else {
      const WatchQuery query{number_of<int>(request, "bits"), number_of<std::uint64_t>(request, "final"),
                             number_of<std::uint64_t>(request, "frame")};
      send(response, "application/octet-stream", std::make_shared<const std::string>(answer_(query)));
    }
  }

  bool process_and_close_socket(socket_t socket) override {
    connections_.take(static_cast<int>(socket));
    return true;
  }

  void serve(const WatchConnections::Question& question) {
    Connection connection(question, connections_.over());
    bool closed = false;
    process_request(connection, true, closed, nullptr);
  }

  const std::string token_ = random_token();
  const std::shared_ptr<const std::string> page_;
  const Visited visited_;
  const Answer answer_;
  int port_ = -1;
  WatchConnections connections_{[this](const WatchConnections::Question& question) { serve(question); }};
  std::thread listener_;
};

WatchServer::WatchServer(int port, std::string page, Visited visited, Answer answer)
    : http_(std::make_unique<Http>(port, std::move(page), std::move(visited), std::move(answer))) {}

WatchServer::~WatchServer() = default;

bool WatchServer::is_idle() const { return http_->is_idle(); }

std::string WatchServer::url() const { return http_->url(); }

}  // namespace isoweave::cli
