#include "options/files.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "isoweave/error.hpp"
#include "isoweave/remote.hpp"

namespace isoweave::cli {
namespace {

constexpr std::string_view kStandardInput = "-";

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const std::filesystem::path first = std::filesystem::weakly_canonical(a, error);
  const std::filesystem::path second = std::filesystem::weakly_canonical(b, error);
  return !error && first == second;
}

}  // namespace

std::string input_file(const std::string& path) { return path == kStandardInput ? "/dev/stdin" : path; }

bool is_read_once(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  return path == kStandardInput || std::filesystem::is_fifo(status) || std::filesystem::is_socket(status);
}

void check_different(std::initializer_list<std::string_view> paths) {
  for (const std::string_view* a = paths.begin(); a != paths.end(); ++a) {
    for (const std::string_view* b = a + 1; b != paths.end(); ++b) {
      if (!a->empty() && !b->empty() && same_file(*a, *b)) {
        throw std::invalid_argument(fmt::format("{}: would be written over {}, expected different files", *b, *a));
      }
    }
  }
}

std::string usual_output(const std::string& input, std::string_view more, std::string_view ending) {
  constexpr std::string_view kPacked = ".gz";
  const bool unnamed = is_read_once(input) || input.find_first_of("*?[") != std::string::npos;
  if (unnamed || input.starts_with("generate:")) throw CLI::RequiredError("--output");
  std::filesystem::path path(input);
  if (!path.has_filename()) path = path.parent_path();
  if (is_url(input)) path = path.filename();
  if (path.extension() == kPacked) path.replace_extension();
  path.replace_filename(path.stem().string() + std::string(more) + std::string(ending));
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    throw CannotWrite(fmt::format("{}: exists; -o names the file that is to be written", path.string()));
  }
  return path.string();
}

void add_clobber_option(CLI::App& verb, bool& no_clobber) {
  verb.add_flag("--no-clobber", no_clobber, "Refuse to replace a file that exists");
}

void check_absent(bool no_clobber, std::initializer_list<std::string_view> outputs) {
  for (const std::string_view output : outputs) {
    std::error_code error;
    if (!no_clobber || output.empty() || !std::filesystem::exists(output, error)) continue;
    throw CannotWrite(fmt::format("{}: exists, and --no-clobber keeps it", output));
  }
}

}  // namespace isoweave::cli
