// Reads the input as a list of names of labels, and makes names of files of them.
#include "isoweave/label_names.hpp"

#include <algorithm>

#include "input_files.hpp"

namespace {

using namespace isoweave;

void read_names(const std::string& path) {
  const std::vector<LabelName> names = read_label_names(path);
  std::vector<std::string> files = label_file_names(names);
  if (files.size() != names.size()) fuzz::broken_promise("a file's name for each label");
  for (const std::string& file : files) {
    if (file.empty() || file.find('/') != std::string::npos) fuzz::broken_promise("a name without a path");
  }
  std::sort(files.begin(), files.end());
  if (std::adjacent_find(files.begin(), files.end()) != files.end()) fuzz::broken_promise("names that differ");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFiles files(fuzz::kInputNames);
  files.put({data, size});
  fuzz::expect_bad_input_at_worst(read_names, files.path());
  return 0;
}
