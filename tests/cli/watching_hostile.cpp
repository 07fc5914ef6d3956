// mesh --watch among clients that have not the address, or never end.
#ifdef ISOWEAVE_HAS_WATCH

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <fstream>
#include <memory>
#include <vector>

#include "sanitized.hpp"
#include "watch_client.hpp"

namespace isoweave::testing::cli_watching_hostile_test {
namespace {

using namespace watch;
using program::Running;

Running endless_run(const files::Folder& folder) {
  return Running(folder.path(), {"mesh", "generate:gyroid:96x96x2000000:uint8", "--iso", "127.5", "-o", "out.ply",
                                 "--slab", "8", "--watch"});
}

// Without the token: idle, letter by letter, headers without end, lines without end, bodies without end, more of them
// all the time.
class HostileClients {
 public:
  explicit HostileClients(int port) : port_(port) {
    for (int n = 0; n < 8; ++n) idle_.push_back(std::make_unique<Connection>(port));
    const std::string body = "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 4000000000\r\n\r\n";
    send_on("", "G");
    send_on("GET / HTTP/1.1\r\n", "A: b\r\n", 50ms);
    for (int n = 0; n < 4; ++n) send_on("GET / HTTP/1.1\r\n", lines());
    for (int n = 0; n < 2; ++n) send_on("GET /", std::string(4096, 'a'));
    send_on(body, std::string(4096, 'a'));
    threads_.emplace_back([this] {
      while (!stop_) {
        for (int n = 0; n < 20; ++n) idle_.push_back(std::make_unique<Connection>(port_));
        std::this_thread::sleep_for(20ms);
        idle_.erase(idle_.begin(), idle_.begin() + static_cast<std::ptrdiff_t>(idle_.size() > 200 ? 20 : 0));
      }
    });
  }
  ~HostileClients() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  static std::string lines() {
    std::string text;
    for (int n = 0; n < 100; ++n) text += "X-" + std::to_string(n) + ": " + std::string(100, 'x') + "\r\n";
    return text;
  }

  // Whenever it is cut off it begins again.
  void send_on(const std::string& head, const std::string& more, std::chrono::milliseconds pause = 0ms) {
    threads_.emplace_back([this, head, more, pause] {
      while (!stop_) {
        Connection connection(port_);
        connection.send(head);
        while (!stop_ && connection.send(more)) std::this_thread::sleep_for(std::max(pause, 1ms));
      }
    });
  }

  int port_;
  std::atomic<bool> stop_ = false;
  std::vector<std::unique_ptr<Connection> > idle_;
  std::vector<std::thread> threads_;
};

// The memory that the system has given to a process.
std::uint64_t resident_bytes(pid_t process) {
  std::ifstream statm("/proc/" + std::to_string(process) + "/statm");
  std::uint64_t all = 0, resident = 0;
  statm >> all >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

TEST(CliWatch, HostileClientsNeitherKeepThePageFromAnybodyNorFillTheMemory) {
  const files::Folder folder;
  Running program = endless_run(folder);
  const Address address = address_of(program);
  std::this_thread::sleep_for(2s);  // until the run holds what it holds
  const std::uint64_t before = resident_bytes(program.process());
  std::uint64_t most = 0;
  {
    const HostileClients clients(address.port);
    const Clock::time_point end = Clock::now() + 3s;
    int answers = 0;
    for (; Clock::now() < end; ++answers) {
      const Clock::time_point start = Clock::now();
      EXPECT_EQ(ask(address, request(address.path)).status, 200);
      EXPECT_LT(Clock::now() - start, testing::kSanitized ? 10s : 2s);
      most = std::max(most, resident_bytes(program.process()));
      std::this_thread::sleep_for(50ms);
    }
    EXPECT_GT(answers, 1);
  }
  EXPECT_FALSE(program.has_ended()) << program.err();
  if (testing::kSanitized) return;
  EXPECT_LT(most, before + 64'000'000);
}

// More of a request than its line and its host is not looked at: no ranges, however many, and no encoding.
TEST(CliWatch, RangesAreNotServed) {
  const files::Folder folder;
  Running program = endless_run(folder);
  const Address address = address_of(program);
  std::string ranges = "Host: 127.0.0.1\r\nRange: bytes=0-1";
  for (int n = 0; n < 2000; ++n) ranges += ",0-1";
  const Answer answer = ask(address, request(address.path, ranges + "\r\n"));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, ask(address, request(address.path)).body);
}

}  // namespace
}  // namespace isoweave::testing::cli_watching_hostile_test

#endif
