// Stands in for the page in builds without the viewer. check_page has refused before.
#include <stdexcept>

#include "page/page.hpp"
#include "page/range_page.hpp"

namespace isoweave::cli {

std::uint64_t page_memory(std::uint64_t, std::uint64_t) { return 0; }

void write_page(OutputFile&, const PageOptions&, Json&, PageContents, const RunControl&) {
  throw std::logic_error("a page in a build without the viewer");
}

void write_range_page(OutputFile&, const Json&) { throw std::logic_error("a page in a build without the viewer"); }

}  // namespace isoweave::cli
