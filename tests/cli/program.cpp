#include "program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace isoweave::program {
namespace {

void redirect(int descriptor, const char* path, int flags) {
  const int file = ::open(path, flags, 0600);
  if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(99);
  ::close(file);
}

// Standard output becomes a pipe whose other end is closed.
void redirect_to_nobody() {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0 || ::dup2(ends[1], STDOUT_FILENO) < 0) ::_exit(99);
  ::close(ends[0]);
  ::close(ends[1]);
}

// In the new process, between fork and exec.
void become_program(const std::string& folder, char* const* arguments, const std::string& out, const std::string& err,
                    const Setup& setup) {
  redirect(STDIN_FILENO, setup.in_path.empty() ? "/dev/null" : setup.in_path.c_str(), O_RDONLY);
  redirect(STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  redirect(STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  if (setup.out_unread) redirect_to_nobody();
  for (const int stream : setup.closed) ::close(stream);
  if (::chdir(folder.c_str()) != 0) ::_exit(99);
  if (setup.file_limit) {
    const rlimit limit{*setup.file_limit, *setup.file_limit};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(99);
  }
  for (const std::string& variable : setup.environment) ::putenv(const_cast<char*>(variable.c_str()));
  ::execv(arguments[0], arguments);
  ::_exit(99);
}

void send_when_ready(const Running& program, const Setup& setup) {
  using namespace std::chrono_literals;
  const auto give_up = std::chrono::steady_clock::now() + 60s;
  while (!setup.ready(program.process()) && std::chrono::steady_clock::now() < give_up) {
    if (program.has_ended()) return;
    std::this_thread::sleep_for(5ms);
  }
  std::this_thread::sleep_for(50ms);
  ::kill(program.process(), setup.signal);
}

}  // namespace

bool has_file_open_in(pid_t process, const files::Folder& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/fd", error)) {
    if (std::filesystem::read_symlink(entry, error).string().starts_with(folder.path() + "/")) return true;
  }
  return false;
}

Running::Running(const std::string& folder, const std::vector<std::string>& arguments, const Setup& setup)
    : out_path_(setup.out_path) {
  const std::string out = out_path_.empty() ? streams_ / "out" : out_path_;
  const std::string err = setup.err_path.empty() ? streams_ / "err" : setup.err_path;
  std::vector<std::string> texts{setup.program};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);

  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("cannot start a process");
  if (process_ == 0) become_program(folder, pointers.data(), out, err, setup);
}

Running::~Running() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

bool Running::has_ended() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == process_;
}

std::string Running::err() const {
  const std::string path = streams_ / "err";
  return std::filesystem::exists(path) ? files::read_bytes(path) : "";
}

Result Running::wait() {
  int status = 0;
  rusage usage{};
  if (::wait4(process_, &status, 0, &usage) != process_) throw std::runtime_error("cannot wait for a process");
  process_ = -1;
  Result result;
  result.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (out_path_.empty()) result.out = files::read_bytes(streams_ / "out");
  result.err = err();
  return result;
}

Result run(const std::string& folder, const std::vector<std::string>& arguments, const Setup& setup) {
  Running program(folder, arguments, setup);
  if (setup.signal != 0) send_when_ready(program, setup);
  return program.wait();
}

bool is_one_line(const std::string& text) {
  return text.starts_with("isoweave: ") && text.find('\n') + 1 == text.size();
}

std::vector<std::string> listing(const files::Folder& folder) { return listing(folder.path()); }

void expect_failed(const Result& result, int code, const std::string& says) {
  EXPECT_EQ(result.code, code) << result.err;
  EXPECT_EQ(result.signal, 0);
  EXPECT_TRUE(is_one_line(result.err)) << result.err;
  EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
  EXPECT_EQ(result.out, "");
}

std::vector<std::string> listing(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace isoweave::program
