#include "options/index.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "isoweave/error.hpp"
#include "report/print.hpp"

namespace isoweave::cli {

void add_index_option(CLI::App& verb, IndexOptions& index) {
  verb.add_option("--index", index.path,
                  "Index of the volume (isoweave index): a file, auto (the one beside the volume or in the cache) or "
                  "off; never changes the result")
      ->capture_default_str();
}

FoundIndex open_index(const IndexOptions& index, const InputOptions& input, const VolumeInfo& volume, bool quiet) {
  const bool part = !input.roi.empty() || !input.step.empty();
  if (index.named()) {
    if (part) {
      throw std::invalid_argument(
          fmt::format("--index: expected a whole volume, found {}", input.roi.empty() ? "--step" : "--roi"));
    }
    return {index.path, read_index(index.path, volume)};
  }
  if (part || index.path == kIndexOff || !input.external) return {};
  const std::string path = find_index(volume);
  if (path.empty()) return {};
  try {
    return {path, read_index(path, volume)};
  } catch (const BadInput& error) {
    if (!quiet) print_note(fmt::format("warning: {}; it is not used, isoweave index makes it anew", error.what()));
    return {};
  }
}

}  // namespace isoweave::cli
