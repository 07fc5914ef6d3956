#include "page/range_page.hpp"

#include <string_view>

#include "page/page_script.hpp"
#include "page/page_template.hpp"

namespace isoweave::cli {

void write_range_page(OutputFile& file, const Json& report) {
  const std::string_view html = range_template();
  const std::size_t mark = html.find(kPageMark);
  write_text(file, html.substr(0, mark));
  write_script(file, "report", report);
  write_text(file, html.substr(mark + kPageMark.size()));
  file.commit();
}

}  // namespace isoweave::cli
