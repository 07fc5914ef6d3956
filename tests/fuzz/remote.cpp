// Reads the input as a URL, and as what a server says of the part that it sends.
#include "isoweave/remote.hpp"

#include <string>

#include "files/content_range.hpp"
#include "files/remote_address.hpp"
#include "input_files.hpp"
#include "isoweave/error.hpp"

namespace {

using namespace isoweave;

void expect_no_secrets(const std::string& url) {
  const std::string shown = shown_url(url);
  if (!is_url(url)) return;
  if (shown.find_first_of("?#") != std::string::npos) fuzz::broken_promise("a URL without a query");
  if (shown_url(shown) != shown) fuzz::broken_promise("what is shown, shown as it is");
  try {
    const RemoteAddress address = remote_address(url);
    if (!address.shown.starts_with(address.server)) fuzz::broken_promise("paths that begin with the server");
    const std::string request = address.request_url(address.shown + "/0/0");
    for (const char letter :
         request.substr(address.base.size(), request.size() - address.base.size() - address.query.size())) {
      if (letter <= ' ' || letter > '~') fuzz::broken_promise("requests of plain letters");
    }
  } catch (const BadInput&) {
    // A URL without a host.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  expect_no_secrets(text);
  const std::optional<ContentRange> range = parse_content_range(text);
  if (range && (range->last < range->first || (range->size && *range->size <= range->last))) {
    fuzz::broken_promise("a range in an object");
  }
  return 0;
}
