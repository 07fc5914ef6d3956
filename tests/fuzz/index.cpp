// Reads the input as an index, under a checksum that fits: as a whole where its first byte is 0, else as what lies
// behind the identity in the index of a small volume. An index is refused, or used to the end.
#include "isoweave/index.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <span>
#include <string>

#include "files/crc32.hpp"
#include "input_files.hpp"
#include "volume/crossed_bricks.hpp"
#include "volume/index_identity.hpp"

namespace {

using namespace isoweave;

constexpr const char* kFormat = "isoweave index 1";

// The index of a volume whose one file stays as it is.
class IndexOfFile {
 public:
  IndexOfFile() {
    std::ofstream(volume_, std::ios::binary) << std::string(18 * 2 * 20 * sizeof(float), '\x3f');
    info_ = open_volume(volume_)->info();
    for (const std::string& text : {std::string(kFormat), volume_identity(info_)}) {
      const std::uint64_t length = text.size();
      std::array<char, sizeof length> bytes{};
      std::memcpy(bytes.data(), &length, sizeof length);
      head_.append(bytes.data(), bytes.size()).append(text);
    }
  }

  const std::string& path() const { return index_; }
  const VolumeInfo& info() const { return info_; }

  void put(std::span<const std::uint8_t> input) const {
    std::string content = input[0] == 0 ? std::string() : head_;
    content.append(input.begin() + 1, input.end());
    const std::uint32_t crc = add_to_crc(0, std::as_bytes(std::span(content)));
    std::ofstream file(index_, std::ios::binary);
    file << content << std::string_view(reinterpret_cast<const char*>(&crc), sizeof crc);
  }

 private:
  fuzz::InputFiles files_{"/:a"};
  std::string index_ = files_.path() + "/a";
  std::string volume_ = files_.path() + "/a_18x2x20_float32.raw";
  VolumeInfo info_;
  std::string head_;
};

const IndexOfFile& index_file() {
  static const IndexOfFile file;
  return file;
}

void use_index(const std::string& path) {
  const VolumeInfo& info = index_file().info();
  const std::shared_ptr<const VolumeIndex> index = read_index(path, info);
  const std::array surfaces{IndexedSurface{0.5, true, true, 1}};
  CrossedBricks bricks(*index, surfaces);
  for (std::int64_t k = 0; k < info.dims[2]; ++k) bricks.unneeded(0, k);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  index_file().put({data, size});
  fuzz::expect_bad_input_at_worst(use_index, index_file().path());
  return 0;
}
