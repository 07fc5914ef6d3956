#include "child.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const char* call) { throw std::system_error(errno, std::generic_category(), call); }

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(file, text.data() + done, text.size() - done);
    if (count <= 0) return;
    done += static_cast<std::size_t>(count);
  }
}

// Whoever needs more memory than there is fails by itself, before the system ends something else.
void limit_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    rlim_t kilobytes = 0;
    if (std::sscanf(line.c_str(), "MemAvailable: %lu kB", &kilobytes) != 1) continue;
    const rlimit limit{kilobytes * 1024, kilobytes * 1024};
    setrlimit(RLIMIT_DATA, &limit);
  }
}

[[noreturn]] void be_child(const std::function<Json()>& work, int file) {
  Json message;
  try {
    limit_memory();
    message["result"] = work();
  } catch (const std::bad_alloc&) {
    message["failure"] = "needs more memory than there is";
  } catch (const std::exception& error) {
    message["failure"] = error.what();
  }
  write_all(file, message.dump());
  // Without destructors: what other libraries do when they end is not measured and may hang.
  _exit(0);
}

// Everything until the other end is closed; false when the time is over before.
bool read_until(int file, Clock::time_point deadline, std::string& text) {
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    pollfd waiting{file, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    std::array<char, 65536> buffer;
    const ssize_t count = read(file, buffer.data(), buffer.size());
    if (count <= 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

Outcome parse_message(const std::string& text, int status) {
  if (WIFSIGNALED(status)) return {{}, std::string("ended by a signal: ") + strsignal(WTERMSIG(status))};
  const Json message = Json::parse(text, nullptr, false);
  if (message.is_discarded()) return {{}, "ended without a result"};
  if (message.contains("failure")) return {{}, message["failure"]};
  return {message["result"], {}};
}

}  // namespace

void have_host_provide_memory(std::int64_t bytes) {
  constexpr std::size_t kPage = 4096;
  const std::size_t size = static_cast<std::size_t>(bytes);
  void* const memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) fail("mmap");
  madvise(memory, size, MADV_HUGEPAGE);
  for (std::size_t at = 0; at < size; at += kPage) static_cast<volatile char*>(memory)[at] = 1;
  munmap(memory, size);
}

Outcome run_in_child(const std::function<Json()>& work, double limit_seconds) {
  malloc_trim(0);  // freed memory of this process would count as the child's
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe2");
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    close(ends[0]);
    be_child(work, ends[1]);
  }
  close(ends[1]);
  std::string text;
  const auto limit = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_seconds));
  const bool in_time = read_until(ends[0], Clock::now() + limit, text);
  if (!in_time) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time) return {{}, "over the time limit of " + std::to_string(std::lround(limit_seconds)) + " s"};
  return parse_message(text, status);
}

}  // namespace bench
