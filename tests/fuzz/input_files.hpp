// Inputs of the fuzzer as files, since readers take paths: one input holds all files that a reader needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isoweave::fuzz {

// Stands between two files in an input.
inline constexpr std::string_view kNextFile = "<NEXT-FILE>";

// The names of the files of this target.
extern const char* const kInputNames;

// A folder of this process under TMPDIR, which should be in memory.
class InputFiles {
 public:
  // Names between colons, of files in this folder and those below; "/:" in front: the folder is opened, not a file.
  explicit InputFiles(std::string_view names);
  ~InputFiles();
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;

  // Replaces all files by those in the input; the last name takes what is left.
  void put(std::span<const std::uint8_t> input);

  // What the reader opens: the folder, or the first file.
  const std::string& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
  std::string path_;
};

// Ends the program, which the fuzzer takes for a crash.
[[noreturn]] void broken_promise(std::string_view what);

// Calls `use`, which may throw BadInput with one line and nothing else.
void expect_bad_input_at_worst(void (*use)(const std::string& path), const std::string& path);

}  // namespace isoweave::fuzz
