#include "signals.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <string_view>

#include "report/print.hpp"

namespace isoweave::cli {
namespace {

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

extern "C" void exit_at_once(int) {
  constexpr std::string_view kLine = "isoweave: interrupted\n";
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, kLine.data(), kLine.size());
  ::_exit(kExitInterrupted);
}

extern "C" void request_stop(int) { stop_requested = true; }

void handle_with(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  // SIGHUP stays ignored under nohup: the program is to outlive the terminal.
  struct sigaction before {};
  if (::sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
    ::sigaction(SIGHUP, &action, nullptr);
  }
}

}  // namespace

void ignore_write_signals() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // open() gives the lowest free number.
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void exit_on_signal() { handle_with(exit_at_once); }

const std::atomic<bool>& stop_flag() { return stop_requested; }

const std::atomic<bool>& stop_on_signal() {
  handle_with(request_stop);
  return stop_requested;
}

}  // namespace isoweave::cli
