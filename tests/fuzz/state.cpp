// Reads the header of the input as a saved state, under a checksum that fits.
#include <cstring>
#include <vector>

#include "files/state_file.hpp"
#include "input_files.hpp"
#include "isoweave/pipeline.hpp"

namespace {

void read_state(const std::string& path) { isoweave::read_checkpoint(path); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static isoweave::fuzz::InputFiles files("/:state-0");
  std::vector<std::uint8_t> state(data, data + size);
  const std::uint32_t crc = isoweave::add_to_crc(0, std::as_bytes(std::span(state)));
  state.resize(size + sizeof(crc));
  std::memcpy(state.data() + size, &crc, sizeof(crc));
  files.put(state);
  isoweave::fuzz::expect_bad_input_at_worst(read_state, files.path());
  return 0;
}
