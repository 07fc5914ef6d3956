#include "watch/watch_connections.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace isoweave::cli {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kThreads = 4;
constexpr std::size_t kMostAsking = 64;
constexpr std::size_t kMostWaiting = 64;
constexpr std::size_t kMostAsked =
    16'384;  // bytes: what browsers send, with the cookies of other pages of this machine
constexpr auto kToAsk = 1s;
constexpr int kBetweenLooks = 20;  // ms between two looks for connections that are out of time
constexpr std::string_view kEnd = "\r\n\r\n";

void close_socket(int socket) {
  ::shutdown(socket, SHUT_RDWR);
  ::close(socket);
}

bool is_host_line(std::string_view line) {
  constexpr std::string_view kHost = "host:";
  return line.size() >= kHost.size() && std::ranges::equal(line.substr(0, kHost.size()), kHost, [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         });
}

// The lines of a request that matter. Ranges, encodings, cookies and bodies would only be work for the server.
std::string what_matters(std::string_view head) {
  std::string kept;
  for (bool first = true; !head.empty(); first = false) {
    const std::string_view line = head.substr(0, head.find("\r\n"));
    if (first || is_host_line(line)) kept += std::string(line) + "\r\n";
    head.remove_prefix(std::min(head.size(), line.size() + 2));
  }
  return kept + "\r\n";
}

}  // namespace

WatchConnections::WatchConnections(Serve serve)
    : serve_(std::move(serve)), wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (wake_ < 0) throw std::runtime_error("expected one more file descriptor, found none");
  threads_.emplace_back([this] { take_in(); });
  for (std::size_t n = 0; n < kThreads; ++n) threads_.emplace_back([this] { answer(); });
}

WatchConnections::~WatchConnections() {
  {
    const std::lock_guard guard(mutex_);
    over_ = true;
  }
  ::eventfd_write(wake_, 1);
  asked_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  for (const int socket : new_) close_socket(socket);
  for (const Question& question : questions_) close_socket(question.socket);
  for (const Asking& asking : asking_) close_socket(asking.socket);
  ::close(wake_);
}

void WatchConnections::take(int socket) {
  {
    const std::lock_guard guard(mutex_);
    new_.push_back(socket);
    // The thread that takes connections in may be behind. The oldest connection has had most of its time.
    if (new_.size() > kMostAsking) {
      close_socket(new_.front());
      new_.erase(new_.begin());
    }
  }
  ::eventfd_write(wake_, 1);
}

void WatchConnections::take_in() {
  while (!over_) {
    add_new();
    wait();
    // Reads what has arrived first, then looks at times: a process that was stopped meanwhile finds both.
    std::erase_if(asking_, [this](Asking& asking) {
      const State state = read_some(asking);
      if (state == State::kAsked && hand_over(asking)) return true;
      if (state == State::kAsking && Clock::now() < asking.until) return false;
      close_socket(asking.socket);
      return true;
    });
  }
}

void WatchConnections::add_new() {
  eventfd_t ignored = 0;
  ::eventfd_read(wake_, &ignored);
  const std::lock_guard guard(mutex_);
  for (const int socket : new_) asking_.push_back({socket, Clock::now() + kToAsk, {}});
  new_.clear();
  const std::size_t most = std::min(asking_.size(), kMostAsking);
  const auto oldest = asking_.begin();
  const auto kept = asking_.end() - static_cast<std::ptrdiff_t>(most);
  std::for_each(oldest, kept, [](const Asking& asking) { close_socket(asking.socket); });
  asking_.erase(oldest, kept);
}

void WatchConnections::wait() const {
  std::vector<pollfd> events{{wake_, POLLIN, 0}};
  for (const Asking& asking : asking_) events.push_back({asking.socket, POLLIN, 0});
  ::poll(events.data(), events.size(), asking_.empty() ? -1 : kBetweenLooks);
}

WatchConnections::State WatchConnections::read_some(Asking& asking) const {
  std::array<char, kMostAsked> came;
  const ssize_t got = ::recv(asking.socket, came.data(), kMostAsked - asking.head.size(), MSG_DONTWAIT);
  const bool later = got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
  asking.head.append(came.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (asking.head.find(kEnd) != std::string::npos) return State::kAsked;
  return later || (got > 0 && asking.head.size() < kMostAsked) ? State::kAsking : State::kGone;
}

bool WatchConnections::hand_over(Asking& asking) {
  const std::lock_guard guard(mutex_);
  if (questions_.size() >= kMostWaiting) return false;
  ++unanswered_;
  questions_.push_back({asking.socket, what_matters(asking.head.substr(0, asking.head.find(kEnd)))});
  asked_.notify_one();
  return true;
}

void WatchConnections::answer() {
  while (true) {
    std::unique_lock lock(mutex_);
    asked_.wait(lock, [this] { return over_ || !questions_.empty(); });
    if (over_) return;
    const Question question = std::move(questions_.front());
    questions_.pop_front();
    lock.unlock();
    serve_(question);
    close_socket(question.socket);
    --unanswered_;
  }
}

}  // namespace isoweave::cli
