#include "input_files.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "isoweave/error.hpp"

namespace isoweave::fuzz {

InputFiles::InputFiles(std::string_view names)
    : folder_(std::filesystem::temp_directory_path() / ("isoweave-fuzz-" + std::to_string(::getpid()))) {
  std::filesystem::create_directory(folder_);
  const bool whole_folder = names.starts_with("/:");
  if (whole_folder) names.remove_prefix(2);
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(':'), names.size());
    const std::filesystem::path name = folder_ / names.substr(0, end);
    std::filesystem::create_directories(name.parent_path());
    names_.push_back(name.string());
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  path_ = whole_folder ? folder_.string() : names_.front();
}

InputFiles::~InputFiles() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void InputFiles::put(std::span<const std::uint8_t> input) {
  std::string_view left(reinterpret_cast<const char*>(input.data()), input.size());
  bool there = true;
  for (const std::string& name : names_) {
    std::filesystem::remove(name);
    if (!there) continue;
    const std::size_t end = &name == &names_.back() ? left.npos : left.find(kNextFile);
    std::ofstream(name, std::ios::binary) << left.substr(0, end);
    there = end != left.npos;
    if (there) left.remove_prefix(end + kNextFile.size());
  }
}

void broken_promise(std::string_view what) {
  std::fprintf(stderr, "broken promise: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

void expect_bad_input_at_worst(void (*use)(const std::string& path), const std::string& path) {
  try {
    use(path);
  } catch (const BadInput& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) broken_promise("a message of one line");
  }
}

}  // namespace isoweave::fuzz
