// Runs the real program in a folder of the test's own.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "files.hpp"

namespace isoweave::program {

struct Result {
  int code = -1;                 // exit status; -1 when a signal ended it
  int signal = 0;                // that ended it
  std::string out;               // standard output
  std::string err;               // standard error
  std::uint64_t peak_bytes = 0;  // largest resident memory, as the system counts it
};

struct Setup {
  std::optional<std::size_t> file_limit;  // bytes, as RLIMIT_FSIZE
  std::string out_path;                   // standard output goes here instead
  std::string in_path;                    // standard input comes from here; nothing: there is none
  std::string err_path;                   // standard error does
  std::vector<int> closed;                // standard streams that are closed
  bool out_unread = false;                // standard output is a pipe that nobody reads
  int signal = 0;                         // sent once `ready`
  std::function<bool(pid_t)> ready;
  std::string program = ISOWEAVE_BINARY;
  std::vector<std::string> environment;  // NAME=VALUE, beside that of the test
};

// The process has a file of this folder open, with a name or without.
bool has_file_open_in(pid_t process, const files::Folder& folder);

// `isoweave ARGUMENTS` on its way in `folder`. The destructor kills it.
class Running {
 public:
  Running(const std::string& folder, const std::vector<std::string>& arguments, const Setup& setup = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  pid_t process() const { return process_; }
  bool has_ended() const;

  // Standard error so far.
  std::string err() const;

  Result wait();

 private:
  files::Folder streams_;
  std::string out_path_;
  pid_t process_ = -1;
};

// Runs `isoweave ARGUMENTS` in `folder`.
Result run(const std::string& folder, const std::vector<std::string>& arguments, const Setup& setup = {});

// Exactly one line, from the program.
bool is_one_line(const std::string& text);

// It ended with this exit code and one line that says so.
void expect_failed(const Result& result, int code, const std::string& says);

// Names of all entries, hidden ones too, sorted.
std::vector<std::string> listing(const std::string& folder);
std::vector<std::string> listing(const files::Folder& folder);

}  // namespace isoweave::program
