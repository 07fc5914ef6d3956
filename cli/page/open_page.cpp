#include "page/open_page.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>

#include "isoweave/error.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every <unistd.h>

namespace isoweave::cli {
namespace {

#ifdef __APPLE__
constexpr const char* kOpener = "open";
#else
constexpr const char* kOpener = "xdg-open";
#endif

[[noreturn]] void refuse(const std::string& path, std::string_view reason) {
  throw CannotWrite(fmt::format("{}: is written, but {}: open it in a browser", path, reason));
}

// Starts the opener in a session of its own, so that an interrupt of this program does not close the browser. What the
// opener prints is lost: its failure is told in one line.
pid_t start_opener(const std::string& path) {
  posix_spawn_file_actions_t streams{};
  posix_spawnattr_t attributes{};
  posix_spawn_file_actions_init(&streams);
  posix_spawnattr_init(&attributes);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&streams, stream, "/dev/null", O_RDWR, 0);
  }
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  std::string program = kOpener;
  std::string page = std::filesystem::absolute(path).string();
  const std::array<char*, 3> arguments{program.data(), page.data(), nullptr};
  pid_t process = -1;
  const int error = posix_spawnp(&process, kOpener, &streams, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&streams);
  if (error == ENOENT) refuse(path, fmt::format("there is no {} to open it with", kOpener));
  if (error != 0)
    refuse(path, fmt::format("{} cannot be started: {}", kOpener, std::generic_category().message(error)));
  return process;
}

// The state in which a process ends; nothing where it goes on: some openers are the browser.
std::optional<int> end_of(pid_t process) {
  using namespace std::chrono_literals;
  constexpr auto kPatience = 3s;
  const auto begun = std::chrono::steady_clock::now();
  int state = 0;
  while (waitpid(process, &state, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() - begun > kPatience) return std::nullopt;
    std::this_thread::sleep_for(20ms);
  }
  return state;
}

}  // namespace

void open_page(const std::string& path) {
  const std::optional<int> state = end_of(start_opener(path));
  if (!state || *state == 0) return;
  refuse(path, fmt::format("{} could not show it", kOpener));
}

}  // namespace isoweave::cli
