// Reads the input as the texts that a user may give: a raw layout, a file's name, a length, a sample type.
#include <stdexcept>
#include <string>

#include "input_files.hpp"
#include "isoweave/pipeline.hpp"

namespace {

using namespace isoweave;

template <class Parse>
void parse(const Parse& function) {
  try {
    function();
  } catch (const std::invalid_argument&) {
    // What these functions promise for texts that they do not understand.
  }
}

void expect_sane(const RawLayout& layout) {
  for (const std::int64_t side : layout.dims) {
    if (side < 1) fuzz::broken_promise("dimensions of at least 1");
  }
  if (layout.skip_bytes < 0) fuzz::broken_promise("a skip of at least 0");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  parse([&] { expect_sane(parse_raw_layout(text)); });
  parse([&] {
    if (const auto layout = raw_layout_from_name(text)) expect_sane(*layout);
  });
  parse([&] { parse_length(text, "mm"); });
  parse_sample_type(text);
  return 0;
}
