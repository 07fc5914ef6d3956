// Writes what isoweave reads of a volume to standard output: a line "nx ny nz type", then the samples.
//   dump_volume PATH [dataset=PATH] [level=N] [channel=N] [time=N]
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/volume.hpp"

namespace {

using isoweave::OpenOptions;

OpenOptions options_of(const std::vector<std::string>& words) {
  OpenOptions options;
  for (const std::string& word : words) {
    const std::size_t end = word.find('=');
    const std::string name = word.substr(0, end), value = word.substr(end + 1);
    if (name == "dataset") options.dataset = value;
    if (name == "level") options.level = std::stoll(value);
    if (name == "channel") options.channel = std::stoll(value);
    if (name == "time") options.time = std::stoll(value);
  }
  return options;
}

void dump(const std::string& path, const OpenOptions& options) {
  const auto source = isoweave::open_volume(path, options);
  const isoweave::VolumeInfo& info = source->info();
  const std::string type(isoweave::sample_type_name(info.type));
  std::printf("%lld %lld %lld %s\n", static_cast<long long>(info.dims[0]), static_cast<long long>(info.dims[1]),
              static_cast<long long>(info.dims[2]), type.c_str());
  std::vector<std::byte> slice(info.slice_bytes());
  for (std::int64_t k = 0; k < info.dims[2]; ++k) {
    source->read(k, 1, slice);
    std::fwrite(slice.data(), 1, slice.size(), stdout);
  }
}

}  // namespace

int main(int count, char** words) {
  try {
    if (count < 2) return 2;
    dump(words[1], options_of({words + 2, words + count}));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
