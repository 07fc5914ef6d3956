#include "page/page_script.hpp"

#include <fmt/format.h>

namespace isoweave::cli {

std::string script_start(std::string_view id) {
  return fmt::format("<script type=\"application/json\" id=\"{}\">", id);
}

std::string script_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace isoweave::cli
